//! The results as a table and as JSON.

use std::fmt::Write as _;

use crate::accuracy::Accuracy;
use crate::compare::Difference;
use crate::engines::Kind;
use crate::measure::Times;
use crate::scaling::Series;

/// One workload drawn by one engine.
pub struct Row {
    pub kind: Kind,
    pub times: Times,
    pub peak: Option<f64>,
    /// From rastrum's picture.
    pub difference: Difference,
}

pub struct Workload {
    pub name: String,
    pub title: String,
    pub width: u32,
    pub height: u32,
    pub is_drawing: bool,
    pub rows: Vec<Row>,
    /// Engines that drew something else, or nothing, and why.
    pub refused: Vec<(Kind, String)>,
    /// What a drawing's list of shapes leaves out.
    pub notes: Vec<String>,
}

#[derive(Default)]
pub struct Report {
    pub machine: Vec<(&'static str, String)>,
    pub rounds: usize,
    pub workloads: Vec<Workload>,
    pub accuracy: Vec<Accuracy>,
    pub scaling: Vec<Series>,
}

/// What rastrum is to reach on one and two threads: vello_cpu's time on one thread by its own.
const GOALS: [(&str, f64, f64); 13] = [
    ("W1", 6.0, 11.0),
    ("W2", 2.3, 4.4),
    ("W3", 7.0, 12.0),
    ("W3a", 2.0, 3.5),
    ("W4", 4.0, 7.5),
    ("W5", 2.3, 4.5),
    ("W6", 1.8, 3.3),
    ("W7", 3.8, 7.0),
    ("W8", 4.5, 8.0),
    ("W9", 2.6, 4.5),
    ("W10", 1.4, 2.4),
    ("W10x", 4.0, 7.5),
    ("W11", 2.5, 4.5),
];
const DRAWING_GOAL: (f64, f64) = (1.5, 2.7);
const DRAWINGS_MEAN_GOAL: (f64, f64) = (2.0, 3.7);

impl Workload {
    fn row(&self, kind: Kind) -> Option<&Row> {
        self.rows.iter().find(|row| row.kind == kind)
    }

    /// vello_cpu's time on one thread by an engine's.
    fn ratio(&self, row: &Row, time: impl Fn(&Times) -> f64) -> Option<f64> {
        let ratio = time(&self.row(Kind::Vello)?.times) / time(&row.times);
        ratio.is_finite().then_some(ratio)
    }

    fn goal(&self, kind: Kind) -> Option<f64> {
        let named = GOALS.iter().find(|(name, ..)| *name == self.name).map(|(_, one, two)| (*one, *two));
        let (one, two) = named.or(self.is_drawing.then_some(DRAWING_GOAL))?;
        match kind {
            Kind::Rastrum(1) => Some(one),
            Kind::Rastrum(2) => Some(two),
            _ => None,
        }
    }

    /// The price of `Exact` antialiasing: its time by that of `Analytic`.
    fn price_of_exact(&self) -> Option<f64> {
        let price = self.row(Kind::RastrumExact)?.times.median() / self.row(Kind::Rastrum(1))?.times.median();
        price.is_finite().then_some(price)
    }
}

impl Report {
    /// The geometric mean of the drawings' ratios to vello_cpu.
    fn drawings_mean(&self, kind: Kind) -> Option<f64> {
        let drawings = self.workloads.iter().filter(|workload| workload.is_drawing);
        let ratios: Option<Vec<f64>> =
            drawings.map(|workload| workload.ratio(workload.row(kind)?, Times::median)).collect();
        let ratios = ratios.filter(|ratios| !ratios.is_empty())?;
        let logs: f64 = ratios.iter().map(|ratio| libm::log(*ratio)).sum();
        Some(libm::exp(logs / ratios.len() as f64))
    }

    pub fn table(&self) -> String {
        let mut out = String::new();
        let machine: Vec<String> = self.machine.iter().map(|(key, value)| format!("{key} {value}")).collect();
        let _ = writeln!(out, "{}; {} rounds", machine.join(", "), self.rounds);
        for workload in &self.workloads {
            self.workload_table(workload, &mut out);
        }
        for (kind, goal) in [(Kind::Rastrum(1), DRAWINGS_MEAN_GOAL.0), (Kind::Rastrum(2), DRAWINGS_MEAN_GOAL.1)] {
            if let Some(mean) = self.drawings_mean(kind) {
                let threads = kind.threads();
                let _ =
                    writeln!(out, "drawings, rastrum on {threads}: geometric mean {mean:.2} x vello_cpu (goal {goal})");
            }
        }
        for Accuracy { title, engines, .. } in &self.accuracy {
            let _ = writeln!(out, "\ncoverage against 64 x 64 samples a pixel, edge pixels of {title}, in 1/255");
            for (kind, errors) in engines {
                let (name, mean, above, max) = (kind.name(), errors.mean(), errors.above16(), errors.max);
                let _ = writeln!(out, "  {name:14} mean {mean:.3}, above 16 {above:.3} %, max {max:.0}");
            }
        }
        for series in &self.scaling {
            let _ = writeln!(out, "\n{}: {}", series.name, series.unit);
            for growth in &series.engines {
                let points: Vec<String> =
                    growth.points.iter().map(|(size, time)| format!("{size:.0}: {time:.2} ms")).collect();
                let (name, all, last) = (growth.kind.name(), growth.exponent(), growth.last_step());
                let _ = writeln!(out, "  {name:14} exponent {all:.2}, last step {last:.2}   {}", points.join(", "));
            }
        }
        out
    }

    fn workload_table(&self, workload: &Workload, out: &mut String) {
        let Workload { name, title, width, height, .. } = workload;
        let _ = writeln!(out, "\n{name}: {title} ({width} x {height})");
        for note in &workload.notes {
            let _ = writeln!(out, "  {note}");
        }
        let _ = writeln!(
            out,
            "  {:14} {:>7} {:>10} {:>10} {:>7} {:>8} {:>8} {:>5} {:>9} {:>7} {:>5}",
            "engine",
            "threads",
            "median ms",
            "min ms",
            "spread",
            "x vello",
            "(min)",
            "goal",
            "peak MiB",
            "mean d",
            "max d"
        );
        let or_dash = |value: Option<f64>, digits: usize| match value {
            Some(value) if value.is_finite() => format!("{value:.digits$}"),
            _ => "-".to_owned(),
        };
        for row in &workload.rows {
            let _ = writeln!(
                out,
                "  {:14} {:>7} {:>10} {:>10} {:>7} {:>8} {:>8} {:>5} {:>9} {:>7.3} {:>5}",
                row.kind.name(),
                row.kind.threads(),
                or_dash(Some(row.times.median()), 3),
                or_dash(Some(row.times.minimum()), 3),
                or_dash(Some(row.times.spread()), 3),
                or_dash(workload.ratio(row, Times::median), 2),
                or_dash(workload.ratio(row, Times::minimum), 2),
                or_dash(workload.goal(row.kind), 1),
                or_dash(row.peak, 1),
                row.difference.mean,
                row.difference.max,
            );
        }
        if let Some(price) = workload.price_of_exact() {
            let _ = writeln!(out, "  Exact takes {price:.2} x the time of Analytic");
        }
        for (kind, reason) in &workload.refused {
            let _ = writeln!(out, "  {} on {} refused: {reason}", kind.name(), kind.threads());
        }
    }

    pub fn json(&self) -> String {
        let mut results = Vec::new();
        let mut refused = Vec::new();
        let mut exact = Vec::new();
        for workload in &self.workloads {
            for row in &workload.rows {
                results.push(object(&[
                    ("workload", text(&workload.name)),
                    ("engine", text(row.kind.name())),
                    ("threads", row.kind.threads().to_string()),
                    ("median_ms", number(Some(row.times.median()))),
                    ("min_ms", number(Some(row.times.minimum()))),
                    ("spread", number(Some(row.times.spread()))),
                    ("ratio_to_vello", number(workload.ratio(row, Times::median))),
                    ("ratio_to_vello_min", number(workload.ratio(row, Times::minimum))),
                    ("goal", number(workload.goal(row.kind))),
                    ("peak_mib", number(row.peak)),
                    ("mean_difference", number(Some(row.difference.mean))),
                    ("max_difference", row.difference.max.to_string()),
                ]));
            }
            for (kind, reason) in &workload.refused {
                refused.push(object(&[
                    ("workload", text(&workload.name)),
                    ("engine", text(kind.name())),
                    ("threads", kind.threads().to_string()),
                    ("reason", text(reason)),
                ]));
            }
            if let Some(price) = workload.price_of_exact() {
                exact.push((workload.name.as_str(), number(Some(price))));
            }
        }
        let accuracy = self.accuracy.iter().map(|Accuracy { key, engines, .. }| {
            let engines = engines.iter().map(|(kind, errors)| {
                let fields = [
                    ("mean", number(Some(errors.mean()))),
                    ("above16_percent", number(Some(errors.above16()))),
                    ("max", number(Some(errors.max))),
                ];
                (kind.name(), object(&fields))
            });
            (*key, object(&engines.collect::<Vec<_>>()))
        });
        let machine: Vec<(&str, String)> = self
            .machine
            .iter()
            .map(|(key, value)| (*key, if *key == "threads" { value.clone() } else { text(value) }))
            .collect();
        let drawings = [
            ("geometric_mean_1_thread", number(self.drawings_mean(Kind::Rastrum(1)))),
            ("geometric_mean_2_threads", number(self.drawings_mean(Kind::Rastrum(2)))),
        ];
        let scaling = self.scaling.iter().flat_map(|series| {
            series.engines.iter().map(|growth| {
                let points: Vec<String> = growth.points.iter().map(|(size, time)| format!("[{size},{time}]")).collect();
                object(&[
                    ("series", text(series.name)),
                    ("engine", text(growth.kind.name())),
                    ("threads", growth.kind.threads().to_string()),
                    ("exponent", number(Some(growth.exponent()))),
                    ("last_step_exponent", number(Some(growth.last_step()))),
                    ("points", array(&points)),
                ])
            })
        });
        let mut fields = vec![
            ("results", array(&results)),
            ("refused", array(&refused)),
            ("machine", object(&machine)),
            ("rounds", self.rounds.to_string()),
        ];
        fields.extend(accuracy);
        fields.extend([
            ("exact_to_analytic", object(&exact)),
            ("drawings", object(&drawings)),
            ("scaling", array(&scaling.collect::<Vec<String>>())),
        ]);
        object(&fields)
    }
}

fn number(value: Option<f64>) -> String {
    match value {
        Some(value) if value.is_finite() => format!("{:.5}", value),
        _ => "null".to_owned(),
    }
}

fn text(value: &str) -> String {
    let mut out = String::from('"');
    for c in value.chars() {
        match c {
            '"' | '\\' => out.extend(['\\', c]),
            c if c.is_control() => {
                let _ = write!(out, "\\u{:04x}", c as u32);
            }
            c => out.push(c),
        }
    }
    out.push('"');
    out
}

fn array(values: &[String]) -> String {
    format!("[{}]", values.join(","))
}

fn object(fields: &[(&str, String)]) -> String {
    let fields: Vec<String> = fields.iter().map(|(key, value)| format!("{}:{value}", text(key))).collect();
    format!("{{{}}}", fields.join(","))
}
