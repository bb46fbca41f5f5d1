//! Whole figures, drawn.

use super::*;
use crate::Trajectory;
use crate::csv::role;
use flexion::system::Channel;

fn channel(name: &str, unit: &'static str) -> Channel {
    Channel { name: name.into(), unit, role: role(name), ..Channel::default() }
}

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
    for text in ["(a)", "(e)", "Tip deflection w₂ [m]", "Axial displacement [10⁻³ m]", "Strain energy [J]"]
    {
        assert!(svg.contains(text), "{text}");
    }
    assert_eq!(count(&svg, "Time t [s]"), 2, "below the lowest panel of each column");
    assert!(svg.contains("DejaVu Sans") && svg.contains("sans-serif"));
}

/// Heights of the highest and lowest point of the curves [px from above].
fn heights(svg: &str) -> [f64; 2] {
    let paths = svg.split("<path d=\"").skip(1).filter_map(|rest| rest.split('"').next());
    let heights = paths.flat_map(|path| path.split_whitespace().skip(2).step_by(3));
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
    assert!(all[1] - all[0] > 200.0 && (all[0] - few[0]).abs() < 0.01 && (all[1] - few[1]).abs() < 0.01);
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
            assert!(drawing.png().unwrap().len() < 500_000);
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
    assert!(count(&dashed, "<path") > count(&solid, "<path") + 20);
    let marked = svg(series(Line::None, Some(Marker::Circle)));
    assert!(count(&marked, "<circle") >= points.len() && marked.contains("10⁻¹²"));
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

/// Height at which words stand in a figure [px from above].
fn height_of(svg: &str, words: &str) -> Option<f64> {
    let before = svg.split(&format!(">{words}<")).next().filter(|before| before.len() < svg.len())?;
    let tag = &before[before.rfind("<text")?..];
    tag.split(" y=\"").nth(1)?.split('"').next()?.parse().ok()
}

#[test]
fn the_legend_and_words_are_clear_of_curves() {
    // Two points a curve: it is the line that counts, not its points.
    let level = |y: f64| vec![(0.0, y), (1.0, y)];
    let series = vec![
        Series::line(Some("lower"), level(0.05)),
        Series::line(Some("upper"), level(0.95)),
        Series::line(None, vec![(0.1, 0.5), (0.3, 0.56)]),
    ];
    let word = |x: f64| Words { points: vec![(x, 0.5), (0.8, 0.5)], text: "name".into(), beside: false };
    let axis = || Axis { range: Some((0.0, 1.0)), ..Axis::new("y", "m") };
    let panel = Panel { x: axis(), y: axis(), series, words: vec![word(0.2), word(0.8)] };
    let svg = Figure { panels: vec![panel], ..Figure::default() }.draw().svg();
    // The frame is 340 px high: the curves pass 17 px within its edges.
    for name in ["lower", "upper"] {
        let y = height_of(&svg, name).unwrap();
        assert!((45.0..335.0).contains(&y), "{name} at {y}");
    }
    // The first is not put on the slope; the second would cover the first.
    assert_eq!(count(&svg, ">name<"), 1);
}
