//! 3D: the scenes S1 to S6b of the design, drawn by rastrum on one and two threads and by `euc` in the same run.
//!
//! `cargo run --release --bin space [SCENE…]`: milliseconds a frame with the clear, the best of some rounds, the goal, and triangles and
//! fragments per second.

#[path = "../space/mod.rs"]
mod space;

use std::time::Instant;

use space::scenes;

fn main() {
    let wanted: Vec<String> = std::env::args().skip(1).collect();
    println!("scene threads ms goal euc-ms euc/rastrum Mtriangles/s Mfragments/s what");
    for scene in scenes::all() {
        if !wanted.is_empty() && !wanted.iter().any(|name| name == scene.name) {
            continue;
        }
        let euc =
            (scene.samples == 1 && space::euc::can_draw(scene.shading)).then(|| best(3, || space::euc::draw(&scene)));
        for (threads, goal) in [(1, scene.goal.0), (2, scene.goal.1)] {
            let mut target = space::rastrum::target(&scene);
            let mut fragments = 0;
            let ms = best(9, || fragments = space::rastrum::draw(&scene, &mut target, threads));
            let ratio = euc.map_or("-".to_owned(), |euc| format!("{:.1}", euc / ms));
            let euc = euc.map_or("-".to_owned(), |euc| format!("{euc:.1}"));
            let triangles = scene.indices.len() as f64 / 3.0 / ms / 1e3;
            let pixels = fragments as f64 / ms / 1e3;
            let (name, what) = (scene.name, scene.what);
            println!("{name} {threads} {ms:.1} {goal} {euc} {ratio} {triangles:.2} {pixels:.1} {what}");
        }
    }
}

/// The shortest of some runs in milliseconds.
fn best(rounds: usize, mut draw: impl FnMut()) -> f64 {
    let mut best = f64::MAX;
    for _ in 0..rounds {
        let start = Instant::now();
        draw();
        best = best.min(start.elapsed().as_secs_f64() * 1e3);
    }
    best
}
