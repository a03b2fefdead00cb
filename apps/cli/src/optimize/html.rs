//! What a search found, as a page of its own: nothing in it comes from elsewhere, nothing in it runs.

mod boxes;
mod chart;
mod icicle;
mod scatter;
mod tables;
mod trace;

use std::fmt::Write as _;

use nestray::plan::optimize::ray_log::RayLog;
use nestray::plan::optimize::{Optimized, Options};

use super::nest::Nest;

pub(super) use self::boxes::Boxes;

/// Of all text and lines.
const STYLE: &str = "body{font:15px/1.5 system-ui,sans-serif;color:#222;max-width:62rem;\
    margin:2rem auto;padding:0 1rem}h1{font-size:1.5rem}h2{font-size:1.15rem;margin-top:2.2rem}\
    svg{width:100%;height:auto;display:block}table{border-collapse:collapse;font-size:14px}\
    td,th{padding:.15rem .6rem;text-align:right;border-bottom:1px solid #e5e5e5;white-space:nowrap}\
    td:first-child,th:first-child{text-align:left}.wide{overflow-x:auto}tr.chosen{font-weight:600}\
    small,.faint{color:#666;font-weight:400}";

/// The page.
pub(super) fn page(
    scene: &str,
    found: &Optimized,
    log: &RayLog,
    options: &Options,
    nest: &Nest,
) -> String {
    let mut page = String::from("<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n");
    let title = format!("The fastest nest for {}", escaped(scene));
    let _ = writeln!(page, "<title>{title}</title>\n<style>{STYLE}</style>\n<h1>{title}</h1>");
    let mix: Vec<String> =
        log.sets.iter().map(|set| format!("{:.0} % {}", 100.0 * set.weight, set.name)).collect();
    let _ = writeln!(
        page,
        "<p>{} plans were tried in {:.1} s, seed {}; {} were timed. A ray of the mix: {}.</p>",
        found.evaluations,
        found.search_seconds,
        options.seed,
        found.finalists.len(),
        escaped(&mix.join(", "))
    );
    let _ = writeln!(page, "<p>{}</p>", tables::verdict(found));
    let mut section = |title: &str, about: &str, body: String| {
        let _ = writeln!(page, "<h2>{title}</h2>\n<p class=\"faint\">{about}</p>\n{body}");
    };
    section(
        "The nest, by where rays spend their time",
        "Each bar is a part of the nest, below what it stands in; its width is the time a ray of the mix \
         spends in it: steps and tests that were counted, times rough prices.",
        icicle::draw(&nest.spent),
    );
    if let Some(boxes) = &nest.boxes {
        section("Where it stands in the scene", boxes::ABOUT, boxes.draw());
    }
    section(
        "Techniques and nests, by kind of rays",
        "Nanoseconds per ray, measured; in brackets what was expected. The darker, the nearer to the \
         fastest of the column. Techniques that were expected to be far too dear, or cannot \
         serve here, were not timed.",
        tables::timed(found, log),
    );
    section(
        "Expected against measured",
        "Nanoseconds per ray of the mix; the chosen plan is the large point. On the line, if both sides \
         reach it, what was expected is what was measured; what counts for a search is the order.",
        scatter::draw(found, log),
    );
    section(
        "How the search went",
        "What the plan of each replica costs, by its goal, and the best for the mix so far.",
        trace::draw(&found.trace, &goals(log)),
    );
    section("Moves", "Steps that were proposed, and taken.", tables::moves(&found.trace));
    page.push_str("</html>\n");
    page
}

/// What replicas try to make cheap, in their order.
fn goals(log: &RayLog) -> Vec<&str> {
    let each = log.sets.iter().map(|set| set.name.as_str()).filter(|_| log.sets.len() > 1);
    std::iter::once("mix").chain(each).collect()
}

/// Text that is no markup.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '&' => out.push_str("&amp;"),
            '"' => out.push_str("&quot;"),
            // What no document may hold.
            letter if letter.is_control() => out.push(' '),
            letter => out.push(letter),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_no_markup() {
        assert_eq!(escaped("a<b>&\"c\u{1}"), "a&lt;b&gt;&amp;&quot;c ");
    }
}
