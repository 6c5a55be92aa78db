//! The page that shows the pictures.

use std::fmt::Write as _;

use super::board::{HEIGHT, WIDTH};
use super::{Row, Section};

const STYLE: &str = "\
:root{color-scheme:light dark;--paper:#fff;--card:#f5f6f8;--ink:#1d2230;--soft:#5b6270;--line:#d9dce2;--link:#1f5fae}
@media(prefers-color-scheme:dark){:root{--paper:#14161b;--card:#1e2128;--ink:#e8eaee;--soft:#a3a9b6;--line:#343946;--link:#8ab8f2}}
*{box-sizing:border-box}
body{margin:0;background:var(--paper);color:var(--ink);font:16px/1.5 system-ui,sans-serif;overflow-wrap:break-word}
header,main,footer{max-width:88rem;margin:0 auto;padding:1rem clamp(.75rem,3vw,2rem)}
h1{font-size:1.9rem;line-height:1.2;margin:.6rem 0}
h2{font-size:1.35rem;margin:2.2rem 0 1rem;padding-top:.6rem;border-top:1px solid var(--line)}
a{color:var(--link)}
nav{display:flex;flex-wrap:wrap;gap:.3rem 1.1rem;padding:.4rem 0}
.soft{color:var(--soft)}
.grid{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(100%,24rem),1fr));gap:1.1rem}
figure{margin:0;background:var(--card);border:1px solid var(--line);border-radius:.5rem;overflow:hidden}
figure:target{outline:3px solid var(--link)}
img{display:block;width:100%;height:auto;background:#fbfbf8}
@media(min-resolution:2dppx){img{image-rendering:pixelated}}
figcaption{padding:.6rem .8rem .8rem}
figcaption b{display:block}
figcaption a{color:inherit;text-decoration:none}
figcaption .number{color:var(--soft);font-weight:400;font-variant-numeric:tabular-nums;margin-right:.5em}
";

/// The page of those rows that were drawn.
pub(super) fn page(sections: &[Section], drawn: impl Fn(&Row) -> bool) -> String {
    let mut out = String::from("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n");
    out.push_str(
        "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n<title>rastrum gallery</title>\n",
    );
    // Writing to a string cannot fail.
    let _ = write!(out, "<style>\n{STYLE}</style>\n</head>\n<body>\n");
    let count = sections.iter().flat_map(Section::rows).filter(|row| drawn(row)).count();
    let _ = write!(
        out,
        "<header>\n<h1>How pixels are chosen</h1>\n<p class=\"soft\">{count} systems of rasterization, each drawn by the library itself. \
         The bytes are the same on every machine.</p>\n<nav>"
    );
    let used = || sections.iter().filter(|section| section.rows().any(&drawn));
    for section in used() {
        let _ = write!(out, "<a href=\"#{}\">{}</a> ", section.id, section.title);
    }
    out.push_str("</nav>\n</header>\n<main>\n");
    for section in used() {
        let _ = write!(out, "<section id=\"{}\">\n<h2>{}</h2>\n<div class=\"grid\">\n", section.id, section.title);
        for row in section.rows().filter(|row| drawn(row)) {
            figure(&mut out, row);
        }
        out.push_str("</div>\n</section>\n");
    }
    let _ = write!(
        out,
        "</main>\n<footer class=\"soft\"><p>Drawn by rastrum {} with <code>rastrum gallery</code>.</p></footer>\n</body>\n</html>\n",
        env!("CARGO_PKG_VERSION")
    );
    out
}

fn figure(out: &mut String, row: &Row) {
    let (name, caption, file) = (escape(row.name), escape(row.caption), row.file());
    let number = row.number;
    let _ = writeln!(
        out,
        "<figure id=\"row-{number}\"><a href=\"{file}\"><img src=\"{file}\" width=\"{WIDTH}\" height=\"{HEIGHT}\" alt=\"{name}: {caption}\"></a>\
         <figcaption><b><a href=\"#row-{number}\"><span class=\"number\">{number}</span>{name}</a></b>{caption}</figcaption></figure>"
    );
}

fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            other => out.push(other),
        }
    }
    out
}
