//! Fonts, read at the first text that needs one: most drawings have none, and a system's fonts take longer
//! to find than an icon to draw.

use std::sync::{Arc, OnceLock};

use rastrum::svg::usvg::fontdb::{Database, Family, ID, Query, Source, Style, Weight};
use rastrum::svg::usvg::{Font, FontResolver, FontStyle};

use crate::args::FontArguments;
use crate::notes;
use crate::report::Failure;

/// The fonts of one run, shared by all files.
pub(crate) struct Fonts<'a> {
    arguments: &'a FontArguments,
    database: OnceLock<Arc<Database>>,
}

impl<'a> Fonts<'a> {
    /// Nothing is read yet, but that the named files and folders are there.
    pub(crate) fn new(arguments: &'a FontArguments) -> Result<Self, Failure> {
        for path in arguments.font_file.iter().chain(&arguments.font_dir) {
            std::fs::metadata(path).map_err(|error| Failure::new(format!("{}: {error}", path.display())))?;
        }
        Ok(Self { arguments, database: OnceLock::new() })
    }

    /// Finds fonts for usvg.
    pub(crate) fn resolver(&self) -> FontResolver<'_> {
        let select = FontResolver::default_font_selector();
        FontResolver {
            select_font: Box::new(move |font, database| {
                let loaded = self.database.get_or_init(|| Arc::new(load(self.arguments)));
                if !Arc::ptr_eq(loaded, database) {
                    *database = loaded.clone();
                }
                select(font, database).or_else(|| any(font, database))
            }),
            select_fallback: FontResolver::default_fallback_selector(),
        }
    }
}

/// Text in a font that was not asked for is better than no text.
fn any(font: &Font, database: &Database) -> Option<ID> {
    let families = [Family::SansSerif, Family::Serif, Family::Monospace];
    let style = match font.style() {
        FontStyle::Normal => Style::Normal,
        FontStyle::Italic => Style::Italic,
        FontStyle::Oblique => Style::Oblique,
    };
    let weight = Weight(font.weight());
    let found = database.query(&Query { families: &families, weight, style, ..Query::default() }).or_else(|| {
        let name = &database.faces().next()?.families.first()?.0;
        database.query(&Query { families: &[Family::Name(name)], weight, style, ..Query::default() })
    });
    let text = match found.and_then(|id| database.face(id)).and_then(|face| face.families.first()) {
        Some((name, _)) => format!("text is drawn in '{name}': none of its own fonts is there"),
        None => "text is left out: there are no fonts; try --font-dir or --font-file".to_owned(),
    };
    notes::add(text);
    found
}

/// A line for each font: family, style, weight, and the file, with its number in a collection.
pub(crate) fn list(arguments: &FontArguments) -> String {
    let database = load(arguments);
    let mut lines: Vec<String> = database
        .faces()
        .map(|face| {
            let family = face.families.first().map_or("", |(name, _)| name.as_str());
            let style = match face.style {
                Style::Normal => "normal",
                Style::Italic => "italic",
                Style::Oblique => "oblique",
            };
            let file = match &face.source {
                Source::File(path) | Source::SharedFile(path, _) => path.display().to_string(),
                Source::Binary(_) => String::new(),
            };
            let number = if face.index > 0 { format!("#{}", face.index) } else { String::new() };
            let line = format!("{family}\t{style}\t{}\t{file}{number}", face.weight.0);
            // A line break in a name would forge a font.
            line.replace(['\n', '\r'], " ") + "\n"
        })
        .collect();
    lines.sort();
    lines.concat()
}

fn load(arguments: &FontArguments) -> Database {
    let mut database = Database::new();
    if !arguments.no_system_fonts {
        database.load_system_fonts();
    }
    for path in &arguments.font_file {
        if let Err(error) = database.load_font_file(path) {
            notes::add(format!("font {} is left out: {error}", path.display()));
        }
    }
    for path in &arguments.font_dir {
        database.load_fonts_dir(path);
    }
    // The system's configuration has named them already, or fontdb's defaults have.
    if let Some(name) = &arguments.serif_family {
        database.set_serif_family(name);
    }
    if let Some(name) = &arguments.sans_serif_family {
        database.set_sans_serif_family(name);
    }
    if let Some(name) = &arguments.cursive_family {
        database.set_cursive_family(name);
    }
    if let Some(name) = &arguments.fantasy_family {
        database.set_fantasy_family(name);
    }
    if let Some(name) = &arguments.monospace_family {
        database.set_monospace_family(name);
    }
    database
}
