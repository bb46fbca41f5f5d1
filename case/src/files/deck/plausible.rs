//! What is unlikely of a blade: a section or a line in other units, with exchanged or permuted axes, or with a slip in one number.
//!
//! The checks hold for anything slender of materials that are in use, and have room: a wave along a bar has the speed √(EA/m), 5,100 m/s in
//! steel and 3,000 to 8,000 m/s in fibre composites; masses and stiffnesses of a section have radii √(J/m) and √(EI/EA) of one size; a blade is
//! stiffer edgewise than flapwise; the shear stiffness of a section is smaller than EA, and GJ smaller than EI₂ + EI₃ but for laminates of
//! ±45°, for an isotropic section it is at most half of that.

use super::Silent;
use super::line::Line;
use super::measures::Measures;
use super::neighbours::Stations;
use super::rows::{Convention, Row};
use flexion::section::Matrices;

/// Speeds of waves along the beam \[m/s\].
const SPEED: [f64; 2] = [500.0, 13_000.0];
/// Ratio of the larger radius of gyration of the stiffness anywhere to the length of the blade.
const SLENDER: [f64; 2] = [5e-4, 0.1];
/// Least ratio of a shear stiffness to EA over the larger part of the span: webs of a twentieth of the area and a fiftieth of the modulus.
const SHEARED: f64 = 1e-3;
/// Least modulus \[Pa\] and density \[kg/m³\] of the material, as [`Measures::least`] gives them: of shells of soft matter as thin as 10⁻⁴ of their radius, and
/// of diamond and osmium.
const MATERIAL: [[f64; 2]; 2] = [[1e3, 2e12], [0.01, 2.5e4]];
/// Largest ratio of the radii of gyration of mass and stiffness, or its inverse.
const RADII: f64 = 2.5;
/// Largest ratio of GJ to the smaller bending stiffness over the larger part of the span: 1.5 for an isotropic strip.
const TWISTING: f64 = 5.0;
/// Least ratio of the edgewise to the flapwise bending stiffness over the larger part of the span.
const EDGEWISE: f64 = 0.8;
/// Ratio of the shear stiffness flapwise to that edgewise, as a mean of its logarithm over the span, and how far stiffnesses of a round root may
/// differ by direction. The skins and caps of a blade lie along its chord, and its webs across: in eight published blades the mean is 0.27 to 0.43, and 1
/// where both were made equal.
const SHEAR: [f64; 2] = [1.7, 1.25];
/// First frequencies of bending times the length \[m/s\], edgewise and flapwise, least and most. Blades of one shape and material have it in common: ten
/// published ones of 61 to 138 m have 63 to 86 and 38 to 63, by [`first_bending`].
const SWAYING: [[f64; 2]; 2] = [[5.0, 700.0], [2.5, 700.0]];
/// Distance of the centre of mass or tension from the line over the larger radius of gyration.
const OFFSET: f64 = 4.0;
/// Factor by which the tip may be stiffer than the root.
const GROWING: f64 = 3.0;
/// Difference of the polar moment of inertia from the sum of the other two, over that.
const POLAR: f64 = 0.02;
/// Largest damping ratio of the first flapwise bending.
const DAMPED: f64 = 0.2;
/// Difference of the two senses of damping times over √(Dᵢᵢ Dⱼⱼ).
const BY_ROWS: f64 = 0.01;

/// What is unlikely of the deck.
pub(super) fn cautions(
    name: &str,
    c: &Convention,
    line: &Line,
    rows: &[Row],
    table: &[(f64, Matrices)],
    (damping, silent): (Option<[f64; 6]>, Silent),
) -> Vec<String> {
    let mut out = Vec::new();
    let length = line.length();
    let measures: Vec<Measures> = table.iter().map(|(_, section)| Measures::of(section)).collect();
    let all = || rows.iter().zip(&measures);
    // The station at which a number is farthest from what is likely, in its logarithm.
    let worst = |of: &dyn Fn(&Measures) -> f64, [least, most]: [f64; 2]| {
        let excess = |m: &Measures| libm::log(of(m) / most).max(libm::log(least / of(m)));
        all().filter(|(_, m)| !(excess(m) <= 0.0)).max_by(|a, b| excess(a.1).total_cmp(&excess(b.1)))
    };

    if let Some((row, m)) = worst(&Measures::speed, SPEED).filter(|_| !silent.axial) {
        out.push(format!(
            "{}: a wave along the blade would have the speed √(EA/m) = {:.4} m/s, with EA from {} = {:.3e} N and m from {} = {:.3e} kg/m; \
             solids in use have {} to {} m/s: is one of both in other units, or is the order of the rows another?",
            row.at(name, c, 0, c.place[0]),
            m.speed(),
            c.entry('K', 0, 0),
            m.axial,
            c.entry('M', 0, 0),
            m.mass,
            SPEED[0],
            SPEED[1]
        ));
    }
    // By the length of the intervals, so that a fine mesh at a round root does not outvote the blade.
    let span = |of: &dyn Fn(&Measures) -> bool| -> f64 {
        let ends = table.windows(2).zip(measures.windows(2));
        ends.map(|(s, m)| 0.5 * (s[1].0 - s[0].0) * f64::from(u8::from(of(&m[0])) + u8::from(of(&m[1]))))
            .sum()
    };
    for (k, which) in ["larger", "smaller"].into_iter().enumerate() {
        let (ratio, limits) = (|m: &Measures| m.radii()[1][k] / m.radii()[0][k], [1.0 / RADII, RADII]);
        let part = span(&|m| !(limits[0]..=limits[1]).contains(&ratio(m))) / length;
        if let Some((row, m)) = worst(&ratio, limits).filter(|_| part > 0.5 && !silent.axial) {
            let [stiff, heavy] = m.radii();
            out.push(format!(
                "{}: the {which} radius of gyration of the mass is {:.4} m, from {}, {} and {}, and that of the stiffness {:.4} m, from \
                 {}, {} and {}; as little alike over {:.0} % of the span; they are of one size in a section: are units or order of one of them others?",
                row.at(name, c, 0, c.place[5 - k]),
                heavy[k],
                c.entry('M', 0, 0),
                c.entry('M', 5, 5),
                c.entry('M', 4, 4),
                stiff[k],
                c.entry('K', 0, 0),
                c.entry('K', 5, 5),
                c.entry('K', 4, 4),
                100.0 * part
            ));
        }
    }
    let largest = measures.iter().flat_map(|m| m.radii()[0]).fold(0.0, f64::max);
    if !silent.axial && !(SLENDER[0] * length..=SLENDER[1] * length).contains(&largest) {
        out.push(format!(
            "{name}: the largest radius of gyration √(EI/EA) is {largest:.4} m and the blade {length:.4} m long, a ratio of {:.2e} where \
             slender beams have {} to {}: is the length, or a stiffness, in other units?",
            largest / length,
            SLENDER[0],
            SLENDER[1]
        ));
    }
    let stiffer = all().filter(|(_, m)| m.shear.iter().any(|shear| *shear > m.axial));
    if let Some((row, m)) = stiffer.clone().next().filter(|_| 2 * stiffer.count() > rows.len()) {
        let k = if m.shear[0] > m.axial { 1 } else { 2 };
        out.push(format!(
            "{}: {} = {:.3e} N is a shear stiffness and larger than the axial {} = {:.3e} N, here and at most stations: the order of rows \
             and columns is shear, shear, axial, bend, bend, torsion",
            row.at(name, c, 0, c.place[k]),
            c.entry('K', k, k),
            m.shear[k - 1],
            c.entry('K', 0, 0),
            m.axial
        ));
    }
    for k in 0..2 {
        let share = |m: &Measures| m.shear[k] / m.axial;
        let part = span(&|m| !(share(m) >= SHEARED)) / length;
        if let Some((row, m)) = worst(&share, [SHEARED, f64::INFINITY]).filter(|_| part > 0.5) {
            out.push(format!(
                "{}: {} = {:.3e} N is a shear stiffness and {:.1e} of the axial {} = {:.3e} N, as little over {:.0} % of the span; the webs of thin blades \
                 have {SHEARED} of it and more: is it in other units?",
                row.at(name, c, 0, c.place[k + 1]),
                c.entry('K', k + 1, k + 1),
                m.shear[k],
                share(m),
                c.entry('K', 0, 0),
                m.axial,
                100.0 * part
            ));
        }
    }
    out.extend(exchanged(name, c, rows, table, &measures).filter(|_| !silent.shear));
    if silent.axial {
        out.extend(swaying(name, c, (rows, table, &measures), length));
    }
    for (k, (letter, what, unit)) in
        [('K', "modulus EA/(4π i₁ i₂)", "Pa"), ('M', "density m/(4π i₁ i₂)", "kg/m³")].into_iter().enumerate()
    {
        let of = |m: &Measures| m.least()[k];
        let part = span(&|m| !(MATERIAL[k][0]..=MATERIAL[k][1]).contains(&of(m))) / length;
        if let Some((row, m)) = worst(&of, MATERIAL[k]).filter(|_| part > 0.5 && !silent.axial) {
            out.push(format!(
                "{}: a section with {} = {:.3e}, {} = {:.3e} and {} = {:.3e} about its centre, of which i₁ and i₂ are the radii of gyration, has the \
                 {what} = {:.2e} {unit} or more, so over {:.0} % of the span, and no material has it: {:.0e} to {:.0e} {unit} are in use: is it in other \
                 units?",
                row.at(name, c, k, c.place[0]),
                c.entry(letter, 0, 0),
                [m.axial, m.mass][k],
                c.entry(letter, 5, 5),
                [m.bending, m.inertia][k][0],
                c.entry(letter, 4, 4),
                [m.bending, m.inertia][k][1],
                of(m),
                100.0 * part,
                MATERIAL[k][0],
                MATERIAL[k][1]
            ));
        }
    }
    let most = |m: &Measures| (m.bending[0] + m.bending[1]).min(TWISTING * m.radii()[0][1].powi(2) * m.axial);
    if span(&|m| m.torsion > most(m)) > 0.5 * length
        && let Some((row, m)) = all().find(|(_, m)| m.torsion > most(m))
    {
        out.push(format!(
            "{}: {} = GJ = {:.3e} N·m² is large beside the bending stiffnesses {} = {:.3e} and {} = {:.3e} N·m² (about the tension centre), as \
             over most of the span: is the order of the rows another?",
            row.at(name, c, 0, c.place[3]),
            c.entry('K', 3, 3),
            m.torsion,
            c.entry('K', 5, 5),
            m.bending[0],
            c.entry('K', 4, 4),
            m.bending[1]
        ));
    }
    for (letter, said, exchanged, values) in [
        (
            'K',
            true,
            span(&|m| m.bending[0] < EDGEWISE * m.bending[1]),
            (|m| m.bending) as fn(&Measures) -> [f64; 2],
        ),
        (
            'M',
            !silent.inertia[1] && !silent.inertia[2],
            span(&|m| m.inertia[0] < EDGEWISE * m.inertia[1]),
            |m| m.inertia,
        ),
    ] {
        if said
            && exchanged > 0.5 * length
            && let Some((row, m)) = all().find(|(_, m)| values(m)[0] < EDGEWISE * values(m)[1])
        {
            let [edge, flap] = values(m);
            out.push(format!(
                "{}: {} = {edge:.3e} is edgewise and smaller than {} = {flap:.3e} flapwise, so over {:.0} % of the span; a blade is stiffer \
                 along its chord: are x and y exchanged? (offsets of the centres are taken off)",
                row.at(name, c, usize::from(letter == 'M'), c.place[5]),
                c.entry(letter, 5, 5),
                c.entry(letter, 4, 4),
                100.0 * exchanged / length
            ));
        }
    }
    for (k, (centre, letter)) in [("tension centre", 'K'), ("centre of mass", 'M')].into_iter().enumerate() {
        let share = |m: &Measures| {
            let [y, z] = m.centres[k];
            libm::hypot(y, z) / m.radii().as_flattened().iter().fold(0.0, |a: f64, b| a.max(*b))
        };
        if let Some((row, m)) = worst(&share, [0.0, OFFSET]) {
            let [y, z] = m.centres[k];
            out.push(format!(
                "{}: the {centre} is {:.4} m off the line, {:.1} times the radius of gyration of the section, from {}, {} and {}",
                row.at(name, c, k, c.place[0]),
                libm::hypot(y, z),
                share(m),
                c.upper(letter, 0, 4),
                c.upper(letter, 0, 5),
                c.entry(letter, 0, 0)
            ));
        }
    }
    if let Some((row, m)) = worst(&|m| m.polar, [1.0 - POLAR, 1.0 + POLAR]) {
        out.push(format!(
            "{}: {} is {:.4} times {} + {}, and in a plane section equal to the sum of both",
            row.at(name, c, 1, c.place[3]),
            c.entry('M', 3, 3),
            m.polar,
            c.entry('M', 4, 4),
            c.entry('M', 5, 5)
        ));
    }
    out.extend(Stations { name, convention: c, rows, measures: &measures, silent }.cautions(table));
    if let (Some(first), Some(last)) = (measures.first(), measures.last())
        && (0..2).all(|k| last.bending[k] > GROWING * first.bending[k])
    {
        out.push(format!(
            "{name}: the bending stiffnesses at the tip are {:.1} and {:.1} times those at the root: do the stations begin at the tip?",
            last.bending[0] / first.bending[0],
            last.bending[1] / first.bending[1]
        ));
    }
    if let Some(times) = damping {
        damped(name, c, (rows, table, &measures), times, &mut out);
    }
    out
}

/// What is unlikely of damping times, and where the two senses of them differ.
fn damped(
    name: &str,
    c: &Convention,
    (rows, table, measures): (&[Row], &[(f64, Matrices)], &[Measures]),
    times: [f64; 6],
    out: &mut Vec<String>,
) {
    let omega = first_bending(table, measures, 1);
    for (k, time) in times.into_iter().enumerate() {
        let ratio = 0.5 * time * omega;
        if ratio > DAMPED {
            out.push(format!(
                "{name}: mu{} = {time} s would damp the first flapwise bending, of about {:.2} Hz, by ζ = μω/2 = {ratio:.2}: mu is in seconds; was \
                 it written in per cent?",
                c.number(k),
                omega / std::f64::consts::TAU
            ));
            break;
        }
    }
    let mut most = (BY_ROWS, None);
    for (row, (_, section)) in rows.iter().zip(table) {
        let k = &section.stiffness;
        for (i, j) in (0..36).map(|n| (n / 6, n % 6)).filter(|(i, j)| i != j) {
            let share = (k[i][j] / (k[i][i] * k[j][j]).sqrt()).abs();
            let differs = if times[i] == times[j] { 0.0 } else { ((times[i] / times[j]).sqrt() - 1.0).abs() };
            if share > 0.0 && share * differs > most.0 {
                most = (share * differs, Some((row, i, j)));
            }
        }
    }
    if let (part, Some((row, i, j))) = most {
        out.push(format!(
            "{}: the damping of {} is √(mu{}·mu{})·K here, so that no motion gains energy, and mu{}·K by rows, as the format has it: they \
             differ by {} of √(D{}{}·D{}{})",
            row.at(name, c, 0, c.place[i]),
            c.entry('K', i, j),
            c.number(i),
            c.number(j),
            c.number(i),
            if part.is_finite() { format!("{:.1} %", 100.0 * part) } else { "more than the whole".to_owned() },
            c.number(i),
            c.number(i),
            c.number(j),
            c.number(j),
        ));
    }
}

/// Shear stiffnesses that are exchanged: those of a round root are equal, and along the blade that across the chord is the larger one.
fn exchanged(
    name: &str,
    c: &Convention,
    rows: &[Row],
    table: &[(f64, Matrices)],
    measures: &[Measures],
) -> Option<String> {
    let (root, length) = (measures.first()?, table.last()?.0);
    let round = |[a, b]: [f64; 2]| (a / b).max(b / a) < SHEAR[1];
    let ratio = |m: &Measures| libm::log(m.shear[1] / m.shear[0]);
    let ends = table.windows(2).zip(measures.windows(2));
    let mean: f64 =
        ends.map(|(s, m)| 0.5 * (s[1].0 - s[0].0) * (ratio(&m[0]) + ratio(&m[1]))).sum::<f64>() / length;
    let (row, most) = rows.iter().zip(measures).max_by(|a, b| ratio(a.1).total_cmp(&ratio(b.1)))?;
    (round(root.shear) && round(root.bending) && mean > libm::log(SHEAR[0])).then(|| {
        format!(
            "{}: the shear stiffness flapwise, {} = {:.3e} N, is {:.1} times that edgewise, {} = {:.3e} N, and {:.1} times along the blade, whose root is round; \
             skins along the chord make a blade stiffer in shear edgewise: are both exchanged?",
            row.at(name, c, 0, c.place[2]),
            c.entry('K', 2, 2),
            most.shear[1],
            most.shear[1] / most.shear[0],
            c.entry('K', 1, 1),
            most.shear[0],
            libm::exp(mean)
        )
    })
}

/// A first frequency of bending that no blade of its length has.
fn swaying(
    name: &str,
    c: &Convention,
    (rows, table, measures): (&[Row], &[(f64, Matrices)], &[Measures]),
    length: f64,
) -> Option<String> {
    let (row, root) = (rows.first()?, measures.first()?);
    [(1, 4, "flapwise"), (0, 5, "edgewise")].into_iter().find_map(|(k, i, sense)| {
        let frequency = first_bending(table, measures, k) / std::f64::consts::TAU;
        let [least, most] = SWAYING[k];
        (!(least..=most).contains(&(frequency * length))).then(|| {
            format!(
                "{}: with {} = {:.3e} N·m² and {} = {:.3e} kg/m here, and what is along it, the blade of {length:.4} m would vibrate {sense} at {frequency:.3e} Hz \
                 first; times its length that is {:.3} m/s, where blades have {least} to {most}, those of wind turbines 38 to 86: is the stiffness, the mass or \
                 the length in other units?",
                row.at(name, c, 0, c.place[i]),
                c.entry('K', i, i),
                root.bending[k],
                c.entry('M', 0, 0),
                root.mass,
                frequency * length
            )
        })
    })
}

/// Angular frequency \[rad/s\] of the first bending edgewise (0) or flapwise (1) by Rayleigh's quotient, with the deflection under a load m s²: a few per
/// cent too high.
fn first_bending(table: &[(f64, Matrices)], measures: &[Measures], k: usize) -> f64 {
    let n = table.len();
    let h = |i: usize| table[i + 1].0 - table[i].0;
    let load: Vec<f64> = table.iter().zip(measures).map(|((s, _), m)| m.mass * s * s).collect();
    let (mut force, mut moment) = (vec![0.0; n], vec![0.0; n]);
    for i in (0..n - 1).rev() {
        force[i] = force[i + 1] + 0.5 * h(i) * (load[i] + load[i + 1]);
        moment[i] = moment[i + 1] + 0.5 * h(i) * (force[i] + force[i + 1]);
    }
    let (mut slope, mut place) = (0.0, 0.0);
    let (mut potential, mut kinetic) = (0.0, 0.0);
    for i in 0..n - 1 {
        let bend = |i: usize| moment[i] / measures[i].bending[k];
        let next = slope + 0.5 * h(i) * (bend(i) + bend(i + 1));
        let there = place + 0.5 * h(i) * (slope + next);
        potential += 0.5 * h(i) * (load[i] * place + load[i + 1] * there);
        kinetic += 0.5 * h(i) * (measures[i].mass * place * place + measures[i + 1].mass * there * there);
        (slope, place) = (next, there);
    }
    if kinetic > 0.0 { (potential / kinetic).sqrt() } else { 0.0 }
}
