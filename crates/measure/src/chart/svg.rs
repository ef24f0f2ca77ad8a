//! A chart as SVG: on white, in colours that colour-blind readers can distinguish, and so that lines that lie on each other are all seen.

use super::axis::Scale;
use super::data::{Chart, FRONT, Series};
use super::ruler::Ruler;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// The colours of Okabe and Ito (2008), without the yellow, which is too pale on white.
const COLOURS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(230, 159, 0),
    RGBColor(0, 158, 115),
    RGBColor(213, 94, 0),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(0, 0, 0),
];
const GREY: RGBColor = RGBColor(90, 90, 90);
const WIDTH: i32 = 760;
const PLOT_HEIGHT: i32 = 340;
/// Free space at the left, right, and between things.
const LEFT: i32 = 76;
const RIGHT: i32 = 24;
const LINE: i32 = 22;
/// Pixels a letter of the labels, at most in the mean.
const LETTER: f64 = 7.4;
const FONT: &str = "sans-serif";

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Pixel = (i32, i32);

/// How a series looks: a colour, and the shape of its line and markers.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Look {
    colour: usize,
    shape: usize,
}

/// What stands in the legend.
#[derive(Clone, Copy)]
enum Sign {
    /// The line of a series.
    Series(Look),
    /// That of the Pareto front.
    Front,
    /// Not above zero on a logarithmic axis.
    Zero,
    /// No number.
    Missing,
}

impl Chart {
    /// The chart as an SVG document of a white ground, the same for the same chart. Lines that lie upon each other grow thinner towards the
    /// top; bars are two standard errors each way; what is not above zero on a logarithmic axis is a triangle on the lower edge, and a
    /// cross on the upper edge is a value that is no number (the line has a gap there).
    pub fn svg(&self) -> String {
        let values = || self.series.iter().flat_map(|s| &s.points);
        let missing = values().any(|p| !p.y.is_finite());
        let zero = self.y.scale == Scale::Log && values().any(|p| p.y <= 0.0);
        let title = wrap(&self.title, (f64::from(WIDTH - 40) / 9.0) as usize);
        let mut entries: Vec<(Sign, &str)> = self
            .looks()
            .into_iter()
            .zip(&self.series)
            .map(|(look, s)| (look.map_or(Sign::Front, Sign::Series), &s.name[..]))
            .collect();
        entries.extend(zero.then_some((Sign::Zero, "not above zero: on the lower edge")));
        entries.extend(missing.then_some((Sign::Missing, "gave no number: on the upper edge")));
        let rows = legend_rows(&entries);

        let top = LINE * (title.len() as i32 + 1) + 10;
        let height = top + PLOT_HEIGHT + 52 + LINE * rows.len() as i32 + 8;
        let mut svg = String::new();
        let root = SVGBackend::with_string(&mut svg, (WIDTH as u32, height as u32)).into_drawing_area();
        let drawn = self.draw(&root, &title, top, &rows).and_then(|()| root.present());
        drop(root);
        // Nothing refuses to be written to a string.
        drawn.map(|()| marked(&svg)).unwrap_or_default()
    }

    fn draw(&self, root: &Area, title: &[String], top: i32, rows: &[Vec<(Sign, &str, i32)>]) -> Drawn {
        root.fill(&WHITE)?;
        for (line, words) in title.iter().enumerate() {
            text(root, words, (WIDTH / 2, 8 + LINE * line as i32), 16, BLACK, HPos::Center)?;
        }
        let zero = rows.iter().flatten().any(|(sign, ..)| matches!(sign, Sign::Zero));
        let note = if zero { " (zero is drawn on the lower edge)" } else { "" };
        text(root, &format!("{}{note}", self.y.label), (12, top - LINE), 13, GREY, HPos::Left)?;
        let bottom = top + PLOT_HEIGHT;
        text(root, &self.x.label, ((WIDTH + LEFT - RIGHT) / 2, bottom + 28), 13, GREY, HPos::Center)?;

        let points = || self.series.iter().flat_map(|s| &s.points);
        let ends = points().filter(|p| p.y.is_finite()).flat_map(|p| {
            // The foot of a bar does not stretch a logarithmic axis: it may be next to zero.
            let foot = if self.y.scale == Scale::Log { 0.0 } else { 2.0 };
            let error = p.error.filter(|e| e.is_finite()).unwrap_or(0.0);
            [p.y - foot * error, p.y + 2.0 * error]
        });
        let y = Ruler::new(&self.y, ends, zero);
        let x = Ruler::new(&self.x, points().map(|p| p.x), false);
        let at = |px: f64, py: f64| {
            let across = x.place(px) * f64::from(WIDTH - LEFT - RIGHT);
            (LEFT + across.round() as i32, bottom - (y.place(py) * f64::from(PLOT_HEIGHT)).round() as i32)
        };

        let (right, pale) = (WIDTH - RIGHT, RGBColor(222, 222, 222));
        for value in x.ticks() {
            let left = at(value, f64::NAN).0;
            root.draw(&PathElement::new([(left, top), (left, bottom)], pale))?;
            text(root, &x.label(value), (left, bottom + 7), 12, BLACK, HPos::Center)?;
        }
        for value in y.ticks() {
            let height = at(f64::NAN, value).1;
            root.draw(&PathElement::new([(LEFT, height), (right, height)], pale))?;
            text(root, &y.label(value), (LEFT - 7, height - 6), 12, BLACK, HPos::Right)?;
        }
        root.draw(&PathElement::new([(LEFT, top), (LEFT, bottom), (right, bottom)], GREY))?;

        // Broad lines first, so that no line hides another.
        let looks = self.looks();
        for front in self.series.iter().filter(|series| series.name == FRONT) {
            let places: Vec<Pixel> = front.points.iter().map(|p| at(p.x, p.y)).collect();
            dashed(root, &places)?;
            places.iter().try_for_each(|place| ring(root, *place))?;
        }
        let mut order: Vec<(Look, &Series)> =
            looks.into_iter().zip(&self.series).filter_map(|(look, series)| Some((look?, series))).collect();
        order.sort_by_key(|(look, _)| look.shape % 3);
        for &(look, series) in &order {
            for run in series.points.split(|p| !p.y.is_finite()).filter(|run| run.len() > 1) {
                root.draw(&PathElement::new(run.iter().map(|p| at(p.x, p.y)).collect::<Vec<_>>(), line(look)))?;
            }
        }
        for &(look, series) in &order {
            for p in &series.points {
                if let Some(error) = p.error.filter(|e| e.is_finite() && *e > 0.0 && p.y.is_finite()) {
                    let (low, high) = (at(p.x, p.y - 2.0 * error), at(p.x, p.y + 2.0 * error));
                    let bars = [
                        [low, high],
                        [(low.0 - 3, low.1), (low.0 + 3, low.1)],
                        [(high.0 - 3, high.1), (high.0 + 3, high.1)],
                    ];
                    for bar in bars.into_iter().filter(|_| low != high) {
                        root.draw(&PathElement::new(bar, look.colour().stroke_width(1)))?;
                    }
                }
            }
        }
        for &(look, series) in &order {
            for p in &series.points {
                match (p.y.is_finite(), self.y.scale) {
                    (false, _) => sign(root, Sign::Missing, (at(p.x, 1.0).0, top), look.colour())?,
                    (true, Scale::Log) if p.y <= 0.0 => sign(root, Sign::Zero, at(p.x, 0.0), look.colour())?,
                    _ => marker(root, look, at(p.x, p.y))?,
                }
            }
        }
        for (row, entries) in rows.iter().enumerate() {
            let height = bottom + 52 + LINE * row as i32 + LINE / 2;
            for &(entry, name, left) in entries {
                let middle = (left + 16, height);
                match entry {
                    Sign::Series(look) => {
                        root.draw(&PathElement::new([(left, height), (left + 32, height)], line(look)))?;
                        marker(root, look, middle)?;
                    }
                    Sign::Front => {
                        dashed(root, &[(left, height), (left + 32, height)])?;
                        ring(root, middle)?;
                    }
                    other => sign(root, other, middle, GREY)?,
                }
                text(root, name, (left + 40, height - 7), 13, BLACK, HPos::Left)?;
            }
        }
        Ok(())
    }
}

type Drawn = Result<(), DrawingAreaErrorKind<std::io::Error>>;

impl Look {
    fn colour(self) -> RGBColor {
        COLOURS[self.colour % COLOURS.len()]
    }
}

impl Chart {
    /// The look of every series; none for the Pareto front.
    fn looks(&self) -> Vec<Option<Look>> {
        let lines = || self.series.iter().filter(|series| series.name != FRONT);
        let pairs: Option<Vec<(&str, &str)>> = lines().map(|series| series.name.rsplit_once(" on ")).collect();
        // The place of each name among the different ones, in the order in which they come.
        let places = |names: Vec<&str>| -> Vec<usize> {
            let mut different: Vec<&str> = Vec::new();
            let mut place = |name| {
                different.iter().position(|other| *other == name).unwrap_or_else(|| {
                    different.push(name);
                    different.len() - 1
                })
            };
            names.into_iter().map(&mut place).collect()
        };
        let looks: Vec<Look> = match pairs {
            None => (0..lines().count()).map(|i| Look { colour: i, shape: i }).collect(),
            Some(pairs) => {
                let (what, on) = pairs.into_iter().unzip();
                places(what).into_iter().zip(places(on)).map(|(colour, shape)| Look { colour, shape }).collect()
            }
        };
        let mut looks = looks.into_iter();
        self.series.iter().map(|series| if series.name == FRONT { None } else { looks.next() }).collect()
    }
}

/// Every third line is broad and pale.
fn line(look: Look) -> ShapeStyle {
    let (width, strength) = [(5, 0.4), (3, 0.65), (1, 1.0)][look.shape % 3];
    look.colour().mix(strength).stroke_width(width)
}

/// A dashed line through some places.
fn dashed(root: &Area, places: &[Pixel]) -> Drawn {
    let (dash, gap) = (6.0, 4.0);
    for pair in places.windows(2) {
        let ((ax, ay), (bx, by)) = (pair[0], pair[1]);
        let (dx, dy) = (f64::from(bx - ax), f64::from(by - ay));
        let length = dx.hypot(dy);
        let on = |along: f64| {
            let share = (along / length).min(1.0);
            (ax + (share * dx).round() as i32, ay + (share * dy).round() as i32)
        };
        let dashes = (length / (dash + gap)).ceil() as usize;
        for start in (0..dashes).map(|number| number as f64 * (dash + gap)) {
            root.draw(&PathElement::new([on(start), on(start + dash)], GREY.stroke_width(1)))?;
        }
    }
    Ok(())
}

/// Around a point of the Pareto front.
fn ring(root: &Area, place: Pixel) -> Drawn {
    root.draw(&Circle::new(place, 11, GREY.stroke_width(1)))
}

/// The markers differ in shape, and those of broad lines are larger: several at one place are all to be seen.
fn marker(root: &Area, look: Look, (x, y): Pixel) -> Drawn {
    let style = look.colour().stroke_width(2);
    let r = [7, 5, 3][look.shape % 3];
    let closed = |corners: &[Pixel]| {
        let path: Vec<Pixel> = corners.iter().chain(&corners[..1]).map(|(dx, dy)| (x + dx, y + dy)).collect();
        root.draw(&PathElement::new(path, style))
    };
    match look.shape % 5 {
        0 => root.draw(&Circle::new((x, y), r, style)),
        1 => closed(&[(-r, -r), (r, -r), (r, r), (-r, r)]),
        2 => root.draw(&Circle::new((x, y), r, look.colour().filled())),
        3 => closed(&[(0, -r - 1), (r + 1, 0), (0, r + 1), (-r - 1, 0)]),
        _ => closed(&[(0, -r - 1), (r + 1, r), (-r - 1, r)]),
    }
}

/// What marks a point that has no place.
fn sign(root: &Area, sign: Sign, (x, y): Pixel, colour: RGBColor) -> Drawn {
    let style = colour.stroke_width(2);
    match sign {
        Sign::Missing => {
            root.draw(&PathElement::new([(x - 5, y - 5), (x + 5, y + 5)], style))?;
            root.draw(&PathElement::new([(x - 5, y + 5), (x + 5, y - 5)], style))
        }
        _ => root.draw(&PathElement::new([(x - 6, y - 6), (x + 6, y - 6), (x, y + 5), (x - 6, y - 6)], style)),
    }
}

fn text(root: &Area, words: &str, at: Pixel, size: i32, colour: RGBColor, side: HPos) -> Drawn {
    // The backend writes a font's size smaller than it is asked for.
    let style = (FONT, 1.24 * f64::from(size)).into_font().color(&colour).pos(Pos::new(side, VPos::Top));
    root.draw(&Text::new(words.to_owned(), at, style))
}

/// Breaks a text between words into lines of about `letters`.
fn wrap(words: &str, letters: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in words.split_whitespace() {
        let last = lines.len() - 1;
        if lines[last].is_empty() {
            lines[last] = word.to_owned();
        } else if lines[last].chars().count() + 1 + word.chars().count() > letters {
            lines.push(word.to_owned());
        } else {
            lines[last] += &format!(" {word}");
        }
    }
    lines
}

/// The legend below the plot, row by row, each entry with its left edge.
fn legend_rows<'a>(entries: &[(Sign, &'a str)]) -> Vec<Vec<(Sign, &'a str, i32)>> {
    let mut rows: Vec<Vec<(Sign, &str, i32)>> = vec![Vec::new()];
    let mut left = LEFT;
    for &(sign, name) in entries {
        let width = 40 + (LETTER * name.chars().count() as f64) as i32 + 20;
        if left > LEFT && left + width > WIDTH {
            rows.push(Vec::new());
            left = LEFT;
        }
        rows.last_mut().into_iter().for_each(|row| row.push((sign, name, left)));
        left += width;
    }
    rows
}

/// The document with the name of the program that made it, by which it knows its own files again.
fn marked(svg: &str) -> String {
    svg.replacen('>', ">\n<!-- made by luminaire -->", 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chart::{Axis, Point};

    fn chart(names: &[&str]) -> Chart {
        let points = vec![Point { x: 1.0, y: 1.0, error: None }, Point { x: 2.0, y: 0.5, error: None }];
        let series = names.iter().map(|name| Series { name: (*name).into(), points: points.clone() }).collect();
        Chart { name: "c".into(), title: "t".into(), x: Axis::log("x"), y: Axis::log("y"), series }
    }

    #[test]
    fn colours_say_what_and_shapes_say_on_what() {
        let look = |colour, shape| Some(Look { colour, shape });
        let looks = chart(&["a on x", FRONT, "b on x", "a on y", "b on y"]).looks();
        assert_eq!(looks, [look(0, 0), None, look(1, 0), look(0, 1), look(1, 1)]);
        assert_eq!(chart(&["a on x", "plain", FRONT]).looks(), [look(0, 0), look(1, 1), None]);
    }

    /// Rings around its points and one in the legend, and a line that is none of the others.
    #[test]
    fn the_front_has_rings() {
        let rings = |names: &[&str]| chart(names).svg().matches("r=\"11\"").count();
        assert_eq!((rings(&["a"]), rings(&["a", FRONT])), (0, 3));
        assert!(chart(&["a", FRONT]).svg().contains(FRONT));
    }

    #[test]
    fn words_are_not_broken() {
        assert_eq!(wrap("one two  three", 7), ["one two", "three"]);
        assert_eq!(wrap("incomprehensible", 4), ["incomprehensible"]);
        assert_eq!(wrap("", 4), [""]);
    }
}
