//! What an SVG tree asks for and does not get.

use std::collections::HashSet;
use std::fmt;

/// Something in an SVG tree that was not drawn, or not as the file asks for.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub struct Warning {
    /// What it is.
    pub kind: WarningKind,
    /// The `id` of the element that shows it, or the pattern's own. Empty where it has none.
    pub id: String,
}

/// The kinds of [`Warning`].
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum WarningKind {
    /// A filter: what it applies to is drawn without it.
    Filter,
    /// An embedded picture that cannot be decoded, and why: it is left out.
    Image(String),
    /// A pattern inside patterns inside patterns, beyond the limit: what it paints is left out.
    PatternDepth,
    /// A pattern whose tile is too large or has no memory: it is drawn at a lower resolution or left out.
    PatternSize,
    /// The tree expands to more elements or layers than the limit: the rest is left out.
    TooComplex,
}

impl fmt::Display for Warning {
    /// One line.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let id = |f: &mut fmt::Formatter<'_>| {
            // An id is any text of the file's; a line break in it would forge a line of its own.
            if self.id.is_empty() { Ok(()) } else { write!(f, " '{}'", self.id.escape_debug()) }
        };
        match &self.kind {
            WarningKind::Filter => {
                f.write_str("element")?;
                id(f)?;
                f.write_str(" is drawn without its filter: filters are not drawn yet")
            }
            WarningKind::Image(reason) => {
                f.write_str("image")?;
                id(f)?;
                write!(f, " is left out: {}", reason.escape_debug())
            }
            WarningKind::PatternDepth => {
                f.write_str("pattern")?;
                id(f)?;
                f.write_str(" is left out: patterns are nested too deeply")
            }
            WarningKind::PatternSize => {
                f.write_str("pattern")?;
                id(f)?;
                f.write_str(" has too large a tile: it is drawn at a lower resolution or left out")
            }
            WarningKind::TooComplex => f.write_str("the drawing expands to too many elements: the rest is left out"),
        }
    }
}

/// Warnings in the order in which they came up, each once.
#[derive(Debug, Default)]
pub(super) struct Warnings {
    list: Vec<Warning>,
    seen: HashSet<Warning>,
}

impl Warnings {
    pub(super) fn add(&mut self, kind: WarningKind, id: &str) {
        let warning = Warning { kind, id: id.to_owned() };
        if self.seen.insert(warning.clone()) {
            self.list.push(warning);
        }
    }

    pub(super) fn into_vec(self) -> Vec<Warning> {
        self.list
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_warning_comes_once_and_is_one_line() {
        let mut warnings = Warnings::default();
        warnings.add(WarningKind::Filter, "a\nb");
        warnings.add(WarningKind::Filter, "a\nb");
        warnings.add(WarningKind::Filter, "");
        let lines: Vec<_> = warnings.into_vec().iter().map(ToString::to_string).collect();
        assert_eq!(
            lines,
            [
                "element 'a\\nb' is drawn without its filter: filters are not drawn yet",
                "element is drawn without its filter: filters are not drawn yet"
            ]
        );
    }
}
