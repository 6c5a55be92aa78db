//! Pictures against tiny-skia's, and against a slow truth.
//!
//! A scene is described once (`scene`) and drawn by rastrum (`canvas`), by tiny-skia (`skia`) and slowly (`truth`).
//! Three gates follow; their limits are in `limits`: interiors, edges by the same sixteen samples, and edges by exact
//! areas, which are to be closer to the truth than tiny-skia is. Pictures of scenes that fail are written to cargo's
//! folder for temporary files of tests.

mod canvas;
mod limits;
mod scene;
mod scenes_composition;
mod scenes_paints;
mod scenes_shapes;
mod skia;
mod truth;

use std::collections::BTreeSet;
use std::path::Path;
use std::sync::OnceLock;

use rastrum::Antialias;

use limits::{Group, Limits};
use scene::{SIZE, Scene};
use truth::Truth;

fn scenes() -> Vec<Scene> {
    [
        scenes_shapes::fills(),
        scenes_shapes::strokes(),
        scenes_paints::gradients(),
        scenes_paints::images(),
        scenes_composition::blends(),
        scenes_composition::clips(),
        scenes_composition::masks(),
        scenes_composition::layers(),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// A scene with what it is compared with.
struct Reference {
    scene: Scene,
    theirs: Vec<[u8; 4]>,
    truth: Truth,
}

/// All scenes, drawn once for all tests.
fn references() -> &'static [Reference] {
    static REFERENCES: OnceLock<Vec<Reference>> = OnceLock::new();
    REFERENCES.get_or_init(|| {
        let draw = |scene: Scene| Reference {
            theirs: skia::draw(&scene).data().as_chunks::<4>().0.to_vec(),
            truth: truth::draw(&scene),
            scene,
        };
        scenes().into_iter().map(draw).collect()
    })
}

/// A scene as each of the painters draws it.
struct Drawn {
    ours: Vec<[u8; 4]>,
    theirs: &'static [[u8; 4]],
    truth: &'static Truth,
}

impl Drawn {
    fn new(reference: &'static Reference, antialias: Antialias) -> Self {
        Self {
            ours: canvas::draw(&reference.scene, antialias).data().as_chunks::<4>().0.to_vec(),
            theirs: &reference.theirs,
            truth: &reference.truth,
        }
    }

    /// The pixel among the interior or the edge ones that differs most, and the share of them that differs by more
    /// than `limit`.
    fn compare(&self, edges: bool, limit: u8) -> (Pixel, f64) {
        let mut worst = Pixel { index: 0, difference: 0, ours: self.ours[0], theirs: self.theirs[0] };
        let (mut count, mut above) = (0_u32, 0_u32);
        for (index, (ours, theirs)) in self.ours.iter().zip(self.theirs).enumerate() {
            if self.truth.zone[index] == edges {
                let difference = (0..4).map(|c| ours[c].abs_diff(theirs[c])).max().unwrap();
                count += 1;
                above += u32::from(difference > limit);
                if difference > worst.difference {
                    worst = Pixel { index, difference, ours: *ours, theirs: *theirs };
                }
            }
        }
        (worst, f64::from(above) / f64::from(count.max(1)))
    }

    /// The mean absolute and the mean signed difference of partly covered pixels from the truth.
    fn errors(&self, pixels: &[[u8; 4]]) -> (f64, f64) {
        let (mut count, mut error, mut signed) = (0.0, 0.0, 0.0);
        for (index, pixel) in pixels.iter().enumerate().filter(|(index, _)| self.truth.partial[*index]) {
            for (value, truth) in pixel.iter().zip(self.truth.pixels[index]) {
                let difference = f64::from(*value) - truth;
                count += 1.0;
                error += difference.abs();
                signed += difference;
            }
        }
        if count > 0.0 { (error / count, signed / count) } else { (0.0, 0.0) }
    }

    /// Writes both pictures and four times their difference, and says where.
    fn save(&self, scene: &Scene, gate: &str) -> String {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
        let plain: String = scene.name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).collect();
        let difference = self.ours.iter().zip(self.theirs).map(|(ours, theirs)| {
            let largest = (0..4).map(|c| ours[c].abs_diff(theirs[c])).max().unwrap();
            [largest.saturating_mul(4); 3].into_iter().chain([255]).collect::<Vec<u8>>()
        });
        for (what, data) in [
            ("rastrum", self.ours.concat()),
            ("tiny-skia", self.theirs.concat()),
            ("difference", difference.collect::<Vec<_>>().concat()),
        ] {
            let size = tiny_skia::IntSize::from_wh(SIZE, SIZE).unwrap();
            let picture = tiny_skia::Pixmap::from_vec(data, size).unwrap();
            picture.save_png(folder.join(format!("reference-{gate}-{plain}-{what}.png"))).unwrap();
        }
        format!("{}/reference-{gate}-{plain}-*.png", folder.display())
    }
}

/// A pixel that differs.
struct Pixel {
    index: usize,
    difference: u8,
    ours: [u8; 4],
    theirs: [u8; 4],
}

impl std::fmt::Display for Pixel {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (x, y) = (self.index % SIZE as usize, self.index / SIZE as usize);
        let Self { difference, ours, theirs, .. } = self;
        write!(f, "{difference} at ({x}, {y}): {ours:?}, tiny-skia {theirs:?}")
    }
}

/// Draws every scene and gathers what `check` complains about, so that one run shows all.
fn gate(name: &str, antialias: Antialias, check: impl Fn(&Drawn, &Limits, &mut Vec<String>)) {
    let mut failures = Vec::new();
    for reference in references() {
        let (scene, drawn) = (&reference.scene, Drawn::new(reference, antialias));
        let mut complaints = Vec::new();
        check(&drawn, Limits::of(scene.group), &mut complaints);
        if !complaints.is_empty() {
            let saved = drawn.save(scene, name);
            failures.push(format!("{} ({:?}):\n  {}\n  {saved}", scene.name, scene.group, complaints.join("\n  ")));
        }
    }
    assert!(failures.is_empty(), "{} scenes differ:\n{}", failures.len(), failures.join("\n"));
}

/// A complaint if `value` exceeds `limit`.
fn at_most(what: &str, value: f64, limit: f64, complaints: &mut Vec<String>) {
    if value > limit {
        complaints.push(format!("{what}: {value:.4}, limit {limit}"));
    }
}

fn interiors(drawn: &Drawn, limits: &Limits, complaints: &mut Vec<String>) {
    let (worst, above) = drawn.compare(false, 1);
    at_most(&format!("interior, {worst}"), f64::from(worst.difference), f64::from(limits.interior), complaints);
    at_most("interior pixels more than 1 apart", above, limits.interior_above_one, complaints);
}

#[test]
fn interiors_are_tiny_skias() {
    for antialias in [Antialias::Analytic, Antialias::Exact, Antialias::Supersample(4)] {
        gate("interior", antialias, interiors);
    }
}

#[test]
fn sixteen_samples_are_tiny_skias() {
    gate("sampled", Antialias::Supersample(4), |drawn, limits, complaints| {
        let (worst, above) = drawn.compare(true, 2);
        at_most(&format!("edge, {worst}"), f64::from(worst.difference), f64::from(limits.sampled_largest), complaints);
        at_most("edge pixels more than 2 apart", above, limits.sampled_above_two, complaints);
    });
}

fn truthful(drawn: &Drawn, limits: &Limits, complaints: &mut Vec<String>) {
    let (error, signed) = drawn.errors(&drawn.ours);
    let (their_error, _) = drawn.errors(drawn.theirs);
    at_most("mean signed error", signed.abs(), limits.signed_error, complaints);
    at_most("mean error", error, limits.error, complaints);
    if error >= their_error && error > 0.0 {
        complaints.push(format!("mean error {error:.3}, tiny-skia's is {their_error:.3}"));
    }
}

#[test]
fn summed_areas_are_closer_to_the_truth_than_tiny_skia() {
    gate("analytic", Antialias::Analytic, |drawn, limits, complaints| {
        let (worst, outside) = drawn.compare(true, limits.band);
        at_most(&format!("edge pixels outside the band, {worst}"), outside, limits.outside_band, complaints);
        truthful(drawn, limits, complaints);
    });
}

#[test]
fn resolved_crossings_are_as_close_to_the_truth_as_edges_that_do_not_cross() {
    gate("exact", Antialias::Exact, |drawn, limits, complaints| {
        let limits = if limits.group == Group::Crossing { Limits::of(Group::Straight) } else { limits };
        truthful(drawn, limits, complaints);
    });
}

#[test]
fn eighty_scenes_and_more_are_compared() {
    let scenes = scenes();
    let names: BTreeSet<&str> = scenes.iter().map(|scene| scene.name.as_str()).collect();
    assert_eq!(names.len(), scenes.len(), "two scenes of one name");
    assert!(scenes.len() >= 80, "{} scenes", scenes.len());
}
