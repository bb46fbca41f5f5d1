//! Whole figures, drawn.

use super::font::Font;
use super::sketch::{Point, Rectangle, Shape};
use super::*;
use crate::Trajectory;
use crate::csv::channel;

/// A spin-up to `speed` in 15 s: a dip of the tip to about −0.4 m and a small vibration afterwards.
fn spin_up(speed: f64, rows: usize) -> Trajectory {
    let columns = [
        ("tip.axial", "m"),
        ("tip.deflection", "m"),
        ("hub.speed", "rad/s"),
        ("energy.kinetic", "J"),
        ("energy.strain", "J"),
    ];
    let mut t = Trajectory::new(columns.iter().map(|(n, u)| channel(n, u)).collect());
    for i in 0..=rows {
        let time = 20.0 * i as f64 / rows as f64;
        let (tau, pi) = ((time / 15.0).min(1.0), std::f64::consts::PI);
        let dip = -0.1 * speed * (pi * tau).sin().powi(2);
        let vibration = 4e-3 * (2.0 * pi * 0.9 * time).sin() * tau.powi(4);
        let omega = speed * (tau - (2.0 * pi * tau).sin() / (2.0 * pi));
        let w = dip + vibration;
        t.push(time, |row| {
            row.copy_from_slice(&[-w * w / 14.0, w, omega, 0.5 * 640.0 * omega * omega, 40.0 * w * w]);
        });
    }
    t
}

fn count(text: &str, what: &str) -> usize {
    text.matches(what).count()
}

#[test]
fn a_run_is_shown_in_lettered_panels_that_share_the_time_axis() {
    let figure = trajectory_figure(&spin_up(4.0, 4000), Some("Spin-up"));
    assert_eq!(figure.panels.len(), 5, "small strain energy has a panel of its own");
    let svg = figure.draw().svg();
    for text in
        ["(a)", "(e)", "Tip deflection w₂ [m]", "Axial displacement", ">[10⁻³ m]<", "Strain energy [J]"]
    {
        assert!(svg.contains(text), "{text}");
    }
    assert_eq!(count(&svg, "Time t [s]"), 2, "below the lowest panel of each column");
    assert!(svg.contains("DejaVu Sans") && svg.contains("sans-serif"));
}

/// Heights of the highest and lowest point of the curves [px from above].
fn heights(svg: &str) -> [f64; 2] {
    // A curve has more points than a frame or a line of the grid, and the width of curves.
    let width = format!("stroke-width=\"{}\"", style::LINE_WIDTH);
    let lines = svg
        .split("<polyline points=\"")
        .skip(1)
        .filter(|rest| rest.split('>').next().is_some_and(|line| line.contains(&width)));
    let points = lines.filter_map(|rest| rest.split('"').next()).flat_map(str::split_whitespace);
    let heights = points.filter_map(|point| point.split(',').nth(1));
    heights.map(|y| y.parse::<f64>().unwrap()).fold([f64::MAX, f64::MIN], |[a, b], y| [a.min(y), b.max(y)])
}

#[test]
fn a_million_rows_give_a_small_file_with_the_same_extremes() {
    const ROWS: u32 = 1_000_000;
    let svg = trajectory_figure(&spin_up(4.0, ROWS as usize), None).draw().svg();
    assert!(svg.len() < 1_000_000, "{} bytes", svg.len());
    // One row goes up and one down, which the second figure shows alone.
    let y = |i: u32| [(123_456, 7.0), (654_321, -3.0)].iter().find(|(row, _)| *row == i).map_or(0.0, |s| s.1);
    let heights_of = |rows: &mut dyn Iterator<Item = u32>| {
        let mut t = Trajectory::new(vec![channel("tip.deflection", "m")]);
        rows.for_each(|i| t.push(f64::from(i), |row| row[0] = y(i)));
        heights(&trajectory_figure(&t, None).draw().svg())
    };
    let (all, few) = (heights_of(&mut (0..=ROWS)), heights_of(&mut [0, 123_456, 654_321, ROWS].into_iter()));
    assert!(all[1] - all[0] > 150.0 && (all[0] - few[0]).abs() < 0.01 && (all[1] - few[1]).abs() < 0.01);
}

#[test]
fn the_same_figure_gives_the_same_bytes() {
    let figure = trajectory_figure(&spin_up(4.0, 1000), None);
    assert_eq!(figure.draw().svg(), figure.draw().svg());
    assert!(figure.draw().png().unwrap() == figure.draw().png().unwrap());
}

#[test]
fn numbers_of_any_size_can_be_drawn() {
    for (a, b) in [
        (0.0, 0.0),
        (0.0, 1e-300),
        (-1e300, 1e300),
        (f64::MIN, f64::MAX),
        (7.0, 7.0),
        (1.0, 1.0 + 1e-15),
        (f64::NAN, f64::NAN),
        (f64::NEG_INFINITY, 1.0),
    ] {
        let points: Vec<(f64, f64)> =
            (0..1000).map(|i| (f64::from(i), if i % 2 == 0 { a } else { b })).collect();
        for scale in [Scale::Linear, Scale::Logarithmic] {
            let axis = Axis { scale, ..Axis::new("y", "m") };
            let panel = Panel {
                x: Axis::time(),
                y: axis,
                series: vec![Series::line(Some("y"), points.clone())],
                ..Panel::default()
            };
            let figure = Figure { panels: vec![panel], ..Figure::default() };
            let drawing = figure.draw();
            let svg = drawing.svg();
            assert!(svg.len() < 200_000 && !svg.contains("NaN") && !svg.contains("inf\""), "{a} {b}");
            // Less than a byte for each of a million pixels, all of which such a curve covers.
            assert!(drawing.png().unwrap().len() < 1_000_000);
        }
    }
}

#[test]
fn a_figure_without_data_shows_empty_axes() {
    assert!(trajectory_figure(&Trajectory::default(), None).draw().svg().contains("<svg"));
    let empty = Trajectory::new(vec![channel("tip.deflection", "m")]);
    assert!(trajectory_figure(&empty, None).draw().svg().contains("Tip deflection"));
}

#[test]
fn runs_are_compared_with_one_legend() {
    let (a, b) = (spin_up(4.0, 500), spin_up(2.0, 500));
    let figure =
        compare_figure(&[("Ω = 4 rad/s", &a), ("Ω = 2 rad/s", &b)], &["tip.deflection", "hub.speed"], None);
    assert_eq!(figure.panels.iter().map(|p| p.series.len()).collect::<Vec<_>>(), [2, 2]);
    let svg = figure.draw().svg();
    assert_eq!((count(&svg, "Ω = 4 rad/s"), count(&svg, "Ω = 2 rad/s")), (1, 1));
}

#[test]
fn dashed_curves_and_marks_are_drawn_on_logarithmic_axes() {
    let points: Vec<(f64, f64)> = (0..6).map(|i| 0.1 / 2f64.powi(i)).map(|h| (h, h.powi(5))).collect();
    let series = |line, marker| Series { line, marker, ..Series::line(Some("radau"), points.clone()) };
    let panel = |s| Panel {
        x: Axis::logarithmic("Step h", "s"),
        y: Axis::logarithmic("Tip error", "m"),
        series: vec![s],
        ..Panel::default()
    };
    let svg = |s| Figure { panels: vec![panel(s)], ..Figure::default() }.draw().svg();
    let (solid, dashed) = (svg(series(Line::Solid, None)), svg(series(Line::Dashed, None)));
    // The curve, and the line of the legend.
    assert_eq!((count(&solid, "stroke-dasharray"), count(&dashed, "stroke-dasharray=\"6 3\"")), (0, 2));
    let marked = svg(series(Line::None, Some(Marker::Circle)));
    assert!(count(&marked, "<polygon") >= points.len() && marked.contains("10⁻¹²"));
}

#[test]
fn a_dashed_curve_may_leave_a_given_range_by_any_amount() {
    let y = Axis { range: Some((0.0, 1.0)), ..Axis::new("y", "m") };
    let points = vec![(0.0, 0.5), (1.0, 1e200), (2.0, 0.5), (3.0, 0.6)];
    let series = vec![Series { line: Line::Dashed, ..Series::line(None, points) }];
    let figure = Figure {
        panels: vec![Panel { x: Axis::time(), y, series, ..Panel::default() }],
        ..Figure::default()
    };
    let svg = figure.draw().svg();
    assert!(svg.len() < 100_000 && !svg.contains("NaN"), "{} bytes", svg.len());
    assert!(figure.draw().png().is_ok());
}

/// Boxes of the texts of a drawing [px].
fn boxes(drawing: &Drawing) -> Vec<(String, Rectangle)> {
    let font = Font::new();
    let of = |shape: &Shape| {
        let Shape::Text { at: (x, y), text, anchor, upright, .. } = shape else { return None };
        let width = font.width(text, style::FONT);
        let (before, after) = (anchor * width, (1.0 - anchor) * width);
        let rectangle = if *upright {
            [x - style::ASCENT, y - after, x + style::DESCENT, y + before]
        } else {
            [x - before, y - style::ASCENT, x + after, y + style::DESCENT]
        };
        Some((text.clone(), rectangle))
    };
    drawing.front.iter().filter_map(of).collect()
}

/// Whether a straight line meets a rectangle: an end of it is inside, or it crosses a side.
fn meets((a, b): (Point, Point), [left, top, right, bottom]: Rectangle) -> bool {
    let inside = |p: Point| p.0 > left && p.0 < right && p.1 > top && p.1 < bottom;
    let side = |p: Point, q: Point, r: Point| (q.0 - p.0) * (r.1 - p.1) - (q.1 - p.1) * (r.0 - p.0);
    let corners = [(left, top), (right, top), (right, bottom), (left, bottom)];
    let crosses =
        |c: Point, d: Point| side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0;
    inside(a) || inside(b) || (0..4).any(|i| crosses(corners[i], corners[(i + 1) % 4]))
}

/// What is wrong with the places of the texts of a drawing.
fn faults(drawing: &Drawing) -> Vec<String> {
    let boxes = boxes(drawing);
    let mut out = Vec::new();
    let curves: Vec<&[Point]> = drawing
        .curves
        .iter()
        .filter_map(|shape| match shape {
            Shape::Line { points, .. } | Shape::Area { points, .. } => Some(points.as_slice()),
            Shape::Text { .. } => None,
        })
        .collect();
    // Legends are white areas, their lines and marks included.
    let legends = drawing.front.iter().filter_map(|shape| match shape {
        Shape::Area { points, ink } if *ink == style::WHITE && points.len() == 4 => {
            Some(("legend".to_owned(), [points[0].0, points[0].1, points[2].0, points[2].1]))
        }
        _ => None,
    });
    let all: Vec<(String, Rectangle)> = boxes.iter().cloned().chain(legends).collect();
    for (text, rectangle) in &all {
        let [left, top, right, bottom] = *rectangle;
        if left < 0.0 || top < 0.0 || right > drawing.size.0 || bottom > drawing.size.1 {
            out.push(format!("{text} leaves the drawing: {rectangle:?}"));
        }
        if curves.iter().any(|curve| curve.windows(2).any(|w| meets((w[0], w[1]), *rectangle))) {
            out.push(format!("{text} meets a curve: {rectangle:?}"));
        }
    }
    for (i, (a, one)) in boxes.iter().enumerate() {
        for (b, other) in &boxes[i + 1..] {
            if one[0] < other[2] && other[0] < one[2] && one[1] < other[3] && other[1] < one[3] {
                out.push(format!("{a} meets {b}: {one:?} {other:?}"));
            }
        }
    }
    out
}

#[test]
fn no_text_or_legend_meets_a_curve_or_another_text_in_random_figures() {
    let mut random = fastrand::Rng::with_seed(7);
    for number in 0..200 {
        let mut figure = Figure { columns: random.usize(1..=2), share_x: random.bool(), ..Figure::default() };
        figure.title =
            random.bool().then(|| "A title of some words that may be longer than one line".to_owned());
        for _ in 0..random.usize(1..=5) {
            let (named, scale) = (random.bool(), 10f64.powi(random.i32(-7..7)));
            let mut panel = Panel {
                x: Axis::time(),
                y: Axis::new("Quantity of the vertical axis, with a symbol y", "kg·m²/s"),
                ..Panel::default()
            };
            for i in 0..random.usize(1..=9) {
                let (a, b, c) = (random.f64(), 30.0 * random.f64(), 6.0 * random.f64());
                let noise = 0.2 * random.f64();
                let points: Vec<(f64, f64)> = (0..=300)
                    .map(|j| f64::from(j) / 300.0)
                    .map(|t| (t, scale * (a * (b * t + c).sin() + a * t + noise * random.f64())))
                    .collect();
                let name = named.then(|| format!("curve {i} of {}", "a name ".repeat(random.usize(0..4))));
                let mut series = Series::line(name.as_deref(), points).numbered(i);
                let last = series.points[series.points.len() - 1];
                let outside = random.bool();
                let points = if outside { vec![last] } else { series.points.clone() };
                let (text, color, leader) = (format!("{i} word"), Some(i), i % 2 == 0);
                panel.words.push(Words { points, text, outside, leader, color });
                if random.u8(0..5) == 0 {
                    (series.line, series.marker) = (Line::None, Some(Marker::Ring));
                    series.points.retain(|_| random.u8(0..20) == 0);
                }
                panel.series.push(series);
            }
            figure.panels.push(panel);
        }
        let drawing = figure.draw();
        assert_eq!(faults(&drawing), Vec::<String>::new(), "figure {number}");
        let names = figure.panels.iter().flat_map(|p| &p.series).filter(|s| s.name.is_some()).count();
        let named = |text: &str| text.starts_with("curve ") || text.starts_with('…');
        assert_eq!(boxes(&drawing).iter().filter(|(text, _)| named(text)).count(), names, "figure {number}");
    }
}

#[test]
fn a_free_corner_takes_the_legend_and_a_full_frame_has_it_above() {
    let top = |points: Vec<(f64, f64)>| {
        let series =
            vec![Series::line(Some("one"), points.clone()), Series::line(Some("two"), points).numbered(1)];
        let panel = Panel { series, ..Panel::default() };
        let drawing = Figure { panels: vec![panel], ..Figure::default() }.draw();
        assert_eq!(faults(&drawing), Vec::<String>::new());
        let (name, frame) = (boxes(&drawing), &drawing.back);
        let name = name.into_iter().find(|(text, _)| text == "one").unwrap().1;
        let Some(Shape::Line { points, .. }) = frame.last() else { panic!("the frame comes last") };
        name[1] - points[0].1
    };
    assert!(top((0..100).map(|i| (f64::from(i), f64::from(i))).collect()) > 0.0);
    assert!(top((0..2000).map(|i| (f64::from(i), (0.3 * f64::from(i)).sin())).collect()) < 0.0);
}

#[test]
fn a_figure_in_a_given_width_has_it_and_stands_in_one_column_where_that_is_narrow() {
    let figure = trajectory_figure(&spin_up(4.0, 400), Some("Spin-up"));
    let places = |width: f64| {
        let drawing = figure.draw_in(width);
        assert_eq!(faults(&drawing), Vec::<String>::new(), "{width} mm");
        assert!((drawing.size.0 - width * 96.0 / 25.4).abs() < 0.5, "{:?} for {width} mm", drawing.size);
        let letters = boxes(&drawing).into_iter().filter(|(text, _)| text.starts_with('('));
        let mut places: Vec<i64> = letters.map(|(_, place)| place[0] as i64).collect();
        places.sort_unstable();
        places.dedup();
        places.len()
    };
    assert_eq!([85.0, 120.0, 180.0].map(places), [1, 2, 2]);
}

#[test]
fn a_range_given_along_sets_the_one_across() {
    let points = (0..=100).map(|i| f64::from(i) / 10.0).map(|t| (t, t.exp())).collect();
    let x = Axis { range: Some((0.0, 1.0)), ..Axis::time() };
    let panel = Panel { x, series: vec![Series::line(None, points)], ..Panel::default() };
    let drawing = Figure { panels: vec![panel], ..Figure::default() }.draw();
    let texts: Vec<String> = boxes(&drawing).into_iter().map(|(text, _)| text).collect();
    assert!(texts.contains(&"2.5".to_owned()) && !texts.iter().any(|text| text.contains('×')), "{texts:?}");
}

/// A reader of PDF finds one page with every line of the drawing, each with its dashes.
#[test]
fn a_reader_of_pdf_finds_every_line_with_its_dashes() {
    let line = |k: u32, line: Line| Series {
        line,
        ..Series::line(Some(&format!("{line:?}")), (0..9).map(|i| (f64::from(i), f64::from(k * i))).collect())
    };
    let series =
        (1..).zip([Line::Solid, Line::Dashed, Line::Dotted]).map(|(k, style)| line(k, style)).collect();
    let drawing = Figure { panels: vec![Panel { series, ..Panel::default() }], ..Figure::default() }.draw();
    let document = lopdf::Document::load_mem(&drawing.pdf().unwrap()).unwrap();
    let pages = document.get_pages();
    assert_eq!(pages.len(), 1);
    let content = document.get_and_decode_page_content(pages[&1]).unwrap();
    let operands = |operator: &'static str| {
        content.operations.iter().filter(move |o| o.operator == operator).map(|o| &o.operands)
    };
    let lengths = |operands: &Vec<lopdf::Object>| -> Vec<f32> {
        assert!(operands.len() == 2 && operands[1].as_float().unwrap() == 0.0, "{operands:?}");
        operands[0].as_array().unwrap().iter().map(|length| length.as_float().unwrap()).collect()
    };
    let found: Vec<Vec<f32>> = operands("d").map(lengths).collect();
    let drawn: Vec<Vec<f32>> = drawing
        .shapes()
        .filter_map(|shape| match shape {
            Shape::Line { dash, .. } => Some(dash.iter().map(|length| *length as f32).collect()),
            _ => None,
        })
        .collect();
    assert_eq!(found, drawn);
    assert_eq!(operands("S").count(), drawn.len());
    assert!(drawn.iter().filter(|dash| dash.len() > 1).count() >= 2, "{drawn:?}");
}

/// Five names of one point: beside it as long as there is room, then at the ends of lines from it that cross no other name.
#[test]
fn names_stand_at_their_point_or_at_the_end_of_a_line_from_it() {
    let at = (0.3, 0.4);
    let axis = || Axis { range: Some((0.0, 1.0)), ..Axis::new("x", "m") };
    let names = ["first-joint", "second-joint", "third-joint", "fourth-joint", "fifth-joint"];
    let name =
        |text: &&str| Words { points: vec![at], text: (*text).to_owned(), leader: true, ..Words::default() };
    let mark = Series { marker: Some(Marker::Circle), line: Line::None, ..Series::line(None, vec![at]) };
    let beam = Series::line(None, vec![at, (0.9, 0.6)]);
    let panel = Panel {
        x: axis(),
        y: axis(),
        series: vec![mark, beam],
        words: names.iter().map(name).collect(),
        ..Panel::default()
    };
    let drawing = Figure { panels: vec![panel], ..Figure::default() }.draw();
    assert_eq!(faults(&drawing), Vec::<String>::new());
    let lines: Vec<[Point; 2]> = drawing
        .front
        .iter()
        .filter_map(|shape| match shape {
            Shape::Line { points, .. } => Some([points[0], points[1]]),
            _ => None,
        })
        .collect();
    let boxes: Vec<(String, Rectangle)> =
        boxes(&drawing).into_iter().filter(|(text, _)| names.contains(&text.as_str())).collect();
    assert_eq!(boxes.len(), names.len());
    let place = lines[0][0];
    assert!(lines.iter().all(|[from, _]| *from == place));
    let outside = |(x, y): Point, [left, top, right, bottom]: Rectangle| {
        (left - x).max(x - right).max(0.0).hypot((top - y).max(y - bottom).max(0.0))
    };
    for (text, rectangle) in &boxes {
        let to = lines.iter().filter(|[_, end]| outside(*end, *rectangle) < 1e-9).count();
        assert!(to == 1 || to == 0 && outside(place, *rectangle) < 10.0, "{text}: {rectangle:?}");
        let crossed = lines.iter().any(|[from, end]| {
            let crosses = meets((*from, *end), *rectangle);
            crosses && outside(*end, *rectangle) > 1e-9
        });
        assert!(!crossed, "{text}");
    }
}

#[test]
fn equal_axes_have_one_scale_in_frames_of_any_shape() {
    let axis = |range| Axis { range: Some(range), ..Axis::new("x", "m") };
    let diagonal = Series::line(None, vec![(0.0, 0.0), (1.0, 1.0)]);
    let (x, y) = (axis((0.0, 1.0)), axis((-0.5, 2.0)));
    let panel = Panel { x, y, series: vec![diagonal], equal: true, ..Panel::default() };
    for count in [1, 3, 5] {
        let figure = Figure { panels: vec![panel.clone(); count], columns: 2, ..Figure::default() };
        for drawing in [figure.draw(), figure.draw_in(80.0), figure.draw_in(300.0)] {
            let line = drawing.curves.iter().find_map(|shape| match shape {
                Shape::Line { points, .. } => Some((points[0], points[points.len() - 1])),
                _ => None,
            });
            let (from, to) = line.unwrap();
            let (along, up) = (to.0 - from.0, from.1 - to.1);
            assert!(along > 10.0 && (along - up).abs() < 1e-9 * along, "{count}: {along} {up}");
        }
    }
}
