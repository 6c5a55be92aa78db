//! What a file asks for, estimated before usvg does it.
//!
//! usvg copies what is referenced for each reference, so that few lines can ask for more work than there is time: each of ten
//! masks on ten shapes under ten masks. The estimate follows the references in attributes and in simple rules of style sheets; a
//! cycle counts once, as usvg breaks it.

use std::borrow::Cow;
use std::collections::HashMap;

use crate::error::{Error, Result};
use usvg::roxmltree::{Document, Node, NodeId, ParsingOptions};

/// How much a file may ask for, for [`parse_with_limits`](super::parse_with_limits).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct ParseLimits {
    /// The most bytes of SVG text, unpacked, entities replaced. The default is 256 MiB.
    pub bytes: usize,
    /// The most nodes of XML. The default is 4,000,000.
    pub nodes: u32,
    /// How deep elements may be nested. The default is 1,024, as many as usvg takes: it recurses into
    /// them, at up to 16 KiB of stack each.
    pub depth: u32,
    /// The most elements when every reference is replaced by what it refers to. The default is 4,000,000.
    pub elements: u64,
    /// The most tests of elements against parts of style sheets' selectors. The default is 1,000,000,000.
    pub style_tests: u64,
    /// The most pairs of characters in the same text element, which is how usvg's time for laying out text grows. The
    /// default is 5,000,000,000: 70,000 characters in one element, some seconds.
    pub text_pairs: u64,
    /// The most attributes of one element. The default is 10,000; the time for reading them grows with the square.
    pub attributes: u32,
}

impl Default for ParseLimits {
    fn default() -> Self {
        Self {
            bytes: 256 << 20,
            nodes: 4_000_000,
            depth: 1024,
            elements: 4_000_000,
            style_tests: 1_000_000_000,
            text_pairs: 5_000_000_000,
            attributes: 10_000,
        }
    }
}

impl ParseLimits {
    /// Refuses a text that asks for more.
    pub(super) fn check(&self, text: &str) -> Result<()> {
        if expanded_length(text) > self.bytes as u64 {
            return Err(Error::Limit(format!("entities make the SVG longer than the limit of {} bytes", self.bytes)));
        }
        if most_attributes(text) > self.attributes as usize {
            return Err(Error::Limit(format!("an element of the SVG has more than {} attributes", self.attributes)));
        }
        let options = ParsingOptions { allow_dtd: true, nodes_limit: self.nodes, ..ParsingOptions::default() };
        // What is no XML is refused, with more to say, by usvg.
        let Ok(document) = Document::parse_with_options(text, options) else { return Ok(()) };
        let estimate = Estimate::new(&document);
        if estimate.depth > self.depth {
            return Err(Error::Limit(format!("the SVG nests its elements more than {} deep", self.depth)));
        }
        if estimate.elements > self.elements {
            return Err(Error::Limit(format!(
                "the SVG's references make more than the limit of {} elements of it",
                self.elements
            )));
        }
        if estimate.style_tests > self.style_tests {
            return Err(Error::Limit("the SVG's style sheets have too many selectors for its elements".to_owned()));
        }
        if estimate.text_pairs > self.text_pairs {
            return Err(Error::Limit("a text of the SVG is too long to be laid out".to_owned()));
        }
        Ok(())
    }
}

/// The text's length with entities replaced, at most 2^64 − 1.
fn expanded_length(text: &str) -> u64 {
    let length = text.len() as u64;
    if !text.contains("<!ENTITY") {
        return length;
    }
    let mut values: HashMap<&str, &str> = HashMap::new();
    for declaration in text.split("<!ENTITY").skip(1) {
        let declaration = declaration.trim_start();
        let Some((name, rest)) = declaration.split_once(char::is_whitespace) else { continue };
        let rest = rest.trim_start();
        let Some(quote) = rest.chars().next().filter(|c| *c == '"' || *c == '\'') else { continue };
        let value = rest.get(1..).and_then(|rest| rest.split(quote).next()).unwrap_or_default();
        values.entry(name).or_insert(value);
    }
    // Entities in entities, to a depth that no honest file has: what is deeper, or goes round, is endless.
    let mut lengths: HashMap<&str, u64> = HashMap::new();
    for _ in 0..16 {
        let next: HashMap<&str, u64> = values.iter().map(|(name, value)| (*name, replaced(value, &lengths))).collect();
        if next == lengths {
            return replaced(text, &lengths);
        }
        lengths = next;
    }
    u64::MAX
}

fn replaced(text: &str, lengths: &HashMap<&str, u64>) -> u64 {
    let references = text.split('&').skip(1).filter_map(|rest| rest.split(';').next());
    references.fold(text.len() as u64, |sum, name| sum.saturating_add(lengths.get(name).copied().unwrap_or(0)))
}

/// The most equals signs in one tag.
fn most_attributes(text: &str) -> usize {
    let tags = text.split('<').map(|rest| rest.split('>').next().unwrap_or_default());
    tags.map(|tag| tag.bytes().filter(|byte| *byte == b'=').count()).max().unwrap_or(0)
}

/// What a document asks for.
struct Estimate {
    depth: u32,
    elements: u64,
    style_tests: u64,
    text_pairs: u64,
}

impl Estimate {
    fn new(document: &Document<'_>) -> Self {
        let mut ids: HashMap<&str, NodeId> = HashMap::new();
        let (mut count, mut parts, mut text_pairs) = (0_u64, 0_u64, 0_u64);
        let mut rules = Vec::new();
        for node in document.descendants().filter(Node::is_element) {
            count += 1;
            if let Some(id) = node.attribute("id") {
                ids.entry(id).or_insert(node.id());
            }
            if node.tag_name().name() == "style" {
                let text = node.text().unwrap_or_default();
                rules.extend(text.split('}').flat_map(linking_rules));
                parts +=
                    text.split('}').map(|rule| selector_parts(rule.split('{').next().unwrap_or_default())).sum::<u64>();
            }
        }
        for text in document.descendants().filter(|node| node.tag_name().name() == "text") {
            let length: u64 =
                text.descendants().filter(Node::is_text).map(|node| node.text().map_or(0, str::len) as u64).sum();
            text_pairs = text_pairs.saturating_add(length.saturating_mul(length));
        }
        let (elements, depth) = cost(document, &ids, &rules);
        // Each rule with a link is tried on each element here, too.
        parts += rules.len() as u64;
        Self { depth, elements, style_tests: parts.saturating_mul(count), text_pairs }
    }
}

/// How many elements a rule's selectors look at for one element: a selector with gaps may look at every ancestor in each.
fn selector_parts(selectors: &str) -> u64 {
    let parts = |selector: &str| {
        let count = selector.split_whitespace().count() as u64;
        count.saturating_mul(count)
    };
    selectors.split(',').map(parts).sum()
}

/// How many elements the root stands for with all references replaced, and how deep elements are nested.
fn cost(document: &Document<'_>, ids: &HashMap<&str, NodeId>, rules: &[LinkingRule<'_>]) -> (u64, u32) {
    struct Frame<'a, 'i> {
        node: Node<'a, 'i>,
        sum: u64,
        /// What is still to count, and how often, the next one last.
        rest: Vec<(NodeId, u64)>,
        /// How often the node itself counts for the one that led to it.
        times: u64,
    }
    let enter = |id: NodeId, times: u64| {
        let node = document.get_node(id)?;
        let mut rest: Vec<(NodeId, u64)> =
            node.children().filter(Node::is_element).map(|child| (child.id(), 1)).collect();
        let links = references(node, ids, rules);
        rest.extend(links.iter().filter_map(|(name, times)| Some((*ids.get(name.as_ref())?, *times))));
        Some(Frame { node, sum: 1, rest, times })
    };
    let depth = |node: Node<'_, '_>| node.ancestors().filter(Node::is_element).count() as u32;
    let mut known: HashMap<NodeId, u64> = HashMap::new();
    let mut deepest = 0;
    let mut frames: Vec<Frame<'_, '_>> = enter(document.root_element().id(), 1).into_iter().collect();
    loop {
        let Some(frame) = frames.last_mut() else { return (0, deepest) };
        match frame.rest.pop() {
            Some((next, times)) => match known.get(&next) {
                // One that is being counted is a cycle, and counts nothing: see below.
                Some(cost) => frame.sum = frame.sum.saturating_add(cost.saturating_mul(times)),
                None => {
                    known.insert(next, 0);
                    frames.extend(enter(next, times));
                }
            },
            None => {
                let (node, sum, times) = (frame.node, frame.sum, frame.times);
                if node.first_element_child().is_none() {
                    deepest = deepest.max(depth(node));
                }
                known.insert(node.id(), sum);
                frames.pop();
                match frames.last_mut() {
                    Some(outer) => outer.sum = outer.sum.saturating_add(sum.saturating_mul(times)),
                    None => return (sum, deepest),
                }
            }
        }
    }
}

/// A rule of a style sheet that links to an element: the last part of its selector, and the ids.
struct LinkingRule<'a> {
    subject: &'a str,
    links: Vec<&'a str>,
}

fn linking_rules(rule: &str) -> Vec<LinkingRule<'_>> {
    let (selectors, declarations) = rule.split_once('{').unwrap_or_default();
    let links = links(declarations);
    if links.is_empty() {
        return Vec::new();
    }
    let subjects = selectors.split(',').filter_map(|selector| selector.split_whitespace().last());
    subjects.map(|subject| LinkingRule { subject, links: links.clone() }).collect()
}

impl LinkingRule<'_> {
    /// Whether the rule may apply to an element. Beyond a name, a class and an id the answer is yes.
    fn may_apply(&self, node: Node<'_, '_>) -> bool {
        let part = self.subject.split([':', '[', '>', '+', '~']).next().unwrap_or_default();
        if let Some(class) = part.strip_prefix('.') {
            return node.attribute("class").is_some_and(|list| list.split_whitespace().any(|own| own == class));
        }
        if let Some(id) = part.strip_prefix('#') {
            return node.attribute("id") == Some(id);
        }
        part.is_empty() || part.contains(['.', '#', '*']) || part == node.tag_name().name()
    }
}

/// The ids in `url(#…)`.
fn links(value: &str) -> Vec<&str> {
    let inside = value.split("url(").skip(1).map(|link| link.split(')').next().unwrap_or_default());
    inside.filter_map(|link| link.trim().trim_matches(['"', '\'']).trim().strip_prefix('#')).collect()
}

/// The ids that an element's attributes and rules refer to, and how often what they name is drawn for it: markers once for each
/// corner of a path.
fn references<'a>(
    node: Node<'a, '_>,
    ids: &HashMap<&str, NodeId>,
    rules: &[LinkingRule<'a>],
) -> Vec<(Cow<'a, str>, u64)> {
    let mut names: Vec<Cow<'a, str>> = Vec::new();
    for attribute in node.attributes() {
        let value = attribute.value();
        if attribute.name() == "href" {
            names.extend(value.trim().strip_prefix('#').map(Cow::Borrowed));
        } else {
            names.extend(links(value).into_iter().map(Cow::Borrowed));
        }
    }
    names.extend(
        rules.iter().filter(|rule| rule.may_apply(node)).flat_map(|rule| rule.links.iter().copied().map(Cow::Borrowed)),
    );
    if names.is_empty() {
        return Vec::new();
    }
    // A number may stand for a corner.
    let data = node.attribute("d").or(node.attribute("points")).unwrap_or_default();
    let corners = data.split(|c: char| !(c.is_ascii_digit() || c == '.')).filter(|number| !number.is_empty()).count();
    let is_marker = |name: &str| {
        let node = ids.get(name).and_then(|id| node.document().get_node(*id));
        node.is_some_and(|node| node.tag_name().name() == "marker")
    };
    let count = |name: Cow<'a, str>| {
        let times = if corners > 1 && is_marker(&name) { corners as u64 } else { 1 };
        (name, times)
    };
    names.into_iter().map(count).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn svg(content: &str) -> String {
        format!("<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink'>{content}</svg>")
    }

    fn elements(content: &str) -> u64 {
        Estimate::new(&Document::parse(&svg(content)).unwrap()).elements
    }

    #[test]
    fn references_count_as_what_they_refer_to() {
        assert_eq!(elements(""), 1);
        // The root, the group with two, and twice three more.
        assert_eq!(elements("<g id='a'><path/><path/></g><use href='#a'/><use xlink:href='#a'/>"), 1 + 3 + 2 * 4);
        assert_eq!(elements("<mask id='m'><rect/></mask><g mask='url(#m)' fill=\"url('#m')\"/>"), 1 + 2 + 1 + 2 * 2);
        assert_eq!(elements("<g id='m'/><path style='fill:none;marker-start:url( #m )'/>"), 1 + 1 + 2);
    }

    #[test]
    fn markers_count_for_each_corner_and_rules_as_attributes() {
        // The root, the marker with its path, and the path with three corners, of which a number is the half.
        assert_eq!(
            elements("<marker id='m'><path/></marker><path d='M0 0L1 1L2 2' marker-mid='url(#m)'/>"),
            1 + 2 + 1 + 6 * 2
        );
        assert_eq!(
            elements("<style>g, .a{mask:url(#m)}</style><mask id='m'><path/></mask><path class='b a'/><rect/>"),
            1 + 1 + 2 + 1 + 2 + 1
        );
    }

    #[test]
    fn long_texts_and_crowds_of_attributes_are_refused() {
        let refused = |content: &str| ParseLimits::default().check(&svg(content)).is_err();
        assert!(refused(&format!("<text>{}</text>", "a".repeat(80_000))));
        assert!(!refused(&format!("<text>{}</text>", "a".repeat(20_000))));
        let attributes: String = (0..11_000).map(|i| format!(" a{i}=''")).collect();
        assert!(refused(&format!("<g{attributes}/>")));
    }

    #[test]
    fn cycles_end_and_bombs_are_seen() {
        assert!(elements("<g id='a'><use href='#b'/></g><g id='b'><use href='#a'/></g>") < 20);
        let mut bomb = "<g id='a0'><path/></g>".to_owned();
        for i in 1..30 {
            bomb += &format!("<g id='a{i}'>{}</g>", format!("<use href='#a{}'/>", i - 1).repeat(10));
        }
        assert!(elements(&bomb) > 1 << 50);
        let error = ParseLimits::default().check(&svg(&bomb)).unwrap_err();
        assert!(matches!(error, Error::Limit(_)), "{error}");
    }

    #[test]
    fn depth_entities_and_selectors_are_limited() {
        let limits = ParseLimits { depth: 10, ..ParseLimits::default() };
        let nested = |n| svg(&format!("{}{}", "<g>".repeat(n), "</g>".repeat(n)));
        assert!(limits.check(&nested(9)).is_ok());
        assert!(limits.check(&nested(10)).is_err());
        let big = format!("<!DOCTYPE svg [<!ENTITY a '{}'>]><svg>{}</svg>", "x".repeat(1 << 16), "&a;".repeat(1 << 13));
        assert!(ParseLimits::default().check(&big).is_err());
        assert!(ParseLimits { bytes: usize::MAX, ..ParseLimits::default() }.check(&big).is_ok());
        let round = "<!DOCTYPE svg [<!ENTITY a '&b;'><!ENTITY b '&a;&a;'>]><svg>&a;</svg>";
        assert!(ParseLimits::default().check(round).is_err());
        let rules = ".a .b .c .d .e .f .g .h{fill:red}".repeat(2_000);
        let styled = svg(&format!("<style>{rules}</style>{}", "<path/>".repeat(10_000)));
        assert!(ParseLimits::default().check(&styled).is_err());
        assert!(ParseLimits::default().check(&svg("<style>.a{fill:red}</style><path/>")).is_ok());
    }
}
