//! `rastrum info`.

use rastrum::SimdLevel;

use crate::args::InfoArguments;
use crate::json;
use crate::report::{self, Failure, Outcome};

pub(crate) fn run(arguments: &InfoArguments) -> Result<Outcome, Failure> {
    let version = env!("CARGO_PKG_VERSION");
    let target = format!("{}-{}", std::env::consts::ARCH, std::env::consts::OS);
    let available: Vec<_> = SimdLevel::available().into_iter().map(SimdLevel::name).collect();
    let chosen = SimdLevel::best().name();
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    // The program is not built without them.
    let features = ["svg", "text", "codec", "parallel"];
    let text = if arguments.json {
        format!(
            "{{\"version\":{},\"target\":{},\"simd\":{{\"available\":{},\"chosen\":{}}},\"threads\":{threads},\"features\":{}}}\n",
            json::string(version),
            json::string(&target),
            json::strings(available),
            json::string(chosen),
            json::strings(features),
        )
    } else {
        format!(
            "rastrum {version} ({target})\n\
             SIMD levels  {} (chosen: {chosen})\n\
             threads      {threads}\n\
             features     {}\n",
            available.join(", "),
            features.join(", "),
        )
    };
    report::print(text.as_bytes())?;
    Ok(Outcome::Done)
}
