//! A formula, seen everywhere: where it breaks, its integral to a checked error, and where steps must end to see it.
//!
//! The range is halved until, in each panel,
//!
//! - [bounds](super::interval) of the values leave no room for what samples miss, to a tenth of ∫|f| there or 10⁻⁷ of
//!   that over the whole range, and decide all comparisons in one way;
//! - two Gauss rules, over the panel and over its halves, differ by less than 10⁻¹³ of these, or by rounding.
//!
//! Changes of branch are located by bisection. Halving ends at 10⁻⁹ of the range: what is still not integrated there is a
//! pole, and refused, if it counts; infinite slopes and kinks that no comparison shows do not.

use super::interval::Interval;
use super::jet::Jet;
use super::program::Program;
use crate::quadrature::Gauss;

/// Gauss points of a panel.
const POINTS: usize = 12;
/// Number of halvings before samples are trusted at all.
const LEAST_DEPTH: u32 = 6;
/// Number of halvings before a change of branch is sought by bisection.
const BISECTION_DEPTH: u32 = 10;
/// Shortest panel, and what is left out at its ends where comparisons are decided, over the range.
const SHORTEST: f64 = 1e-9;
const EDGE: f64 = 1e-10;
/// Largest number of panels.
const MOST: usize = 1 << 17;
/// Tolerance of the integral, over ∫|f|.
const TOLERANCE: f64 = 1e-13;
/// Room for values that samples have not shown: over ∫|f| in the panel, and over the whole range.
const ROOM: (f64, f64) = (0.1, 1e-7);
/// Part of ∫|f| that is left in a shortest panel by a pole.
const POLE: f64 = 1e-3;
/// What three points may miss between two neighbouring times of the resolution: of ∫|f| there, and of the whole.
const SEEN: (f64, f64) = (0.05, 1e-6);

/// Why a formula is refused.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Refused {
    /// It is this, no finite number, at this time.
    NotFinite(f64, f64),
    /// It grows beyond all bounds near this time.
    Pole(f64),
    /// It varies too fast for so long a range.
    TooFast,
}

/// What was found.
#[derive(Clone, Debug)]
pub(super) struct Panels {
    /// Times at which a comparison is decided differently, ascending.
    pub breaks: Vec<f64>,
    /// Between two neighbours, ends and breaks included, three points see the formula.
    pub resolution: Vec<f64>,
    /// Ends of the panels, from 0.
    grid: Vec<f64>,
    /// ∫ from 0 to each end, of f, and of |f|, |f′| and |f″|.
    sums: Vec<f64>,
    sizes: Vec<[f64; 3]>,
    gauss: Gauss,
    /// Shortest panels that are not integrated to the tolerance: start and ∫|f|.
    doubtful: Vec<(f64, f64)>,
}

impl Panels {
    /// Looks at `program` from 0 to `extent`.
    pub fn new(program: &Program, extent: f64) -> Result<Panels, Refused> {
        let mut scan = Scan { program, extent, rules: [3, POINTS].map(Gauss::new), total: 0.0 };
        let coarse = extent / f64::from(1 << LEAST_DEPTH);
        let seen =
            (0..1 << LEAST_DEPTH).map(|k| scan.sizes(1, f64::from(k) * coarse, f64::from(k + 1) * coarse)[0]);
        scan.total = Some(seen.sum()).filter(|total: &f64| total.is_finite()).unwrap_or(0.0);
        let mut panels = scan.panels()?;
        let total = panels.sizes[panels.sizes.len() - 1][0];
        if !(0.5 * total..=2.0 * total).contains(&scan.total) {
            // With ∫|f| known: what seemed to count before may not, and the other way round.
            scan.total = total;
            panels = scan.panels()?;
        }
        let mut ends = vec![0.0];
        ends.extend(panels.breaks.iter().filter(|t| (0.0..extent).contains(*t) && **t > 0.0));
        ends.push(extent);
        let mut resolution = Vec::new();
        for part in ends.windows(2) {
            panels.resolve(&scan, part[0], part[1], &mut resolution);
        }
        panels.resolution = resolution;
        Ok(panels)
    }

    /// The panel in which t lies.
    fn panel(&self, t: f64) -> usize {
        self.grid.partition_point(|start| *start <= t).saturating_sub(1)
    }

    /// ∫ from 0 to t.
    pub fn integral(&self, program: &Program, t: f64) -> f64 {
        let i = self.panel(t);
        self.sums[i] + self.gauss.integrate(self.grid[i], t, |t| program.value(t))
    }

    /// Adds times between a and b until three points see the formula and its derivatives in between.
    fn resolve(&self, scan: &Scan<'_>, a: f64, b: f64, out: &mut Vec<f64>) {
        let middle = 0.5 * (a + b);
        if b - a > SHORTEST * scan.extent && out.len() < MOST && !self.are_seen(scan, a, b, 2) {
            self.resolve(scan, a, middle, out);
            out.push(middle);
            self.resolve(scan, middle, b, out);
        }
    }

    /// Whether three points see it from a to b, and in the halves of that: fast waves may seem to be seen by chance.
    fn are_seen(&self, scan: &Scan<'_>, a: f64, b: f64, depth: u32) -> bool {
        let middle = 0.5 * (a + b);
        let halves = |depth| self.are_seen(scan, a, middle, depth) && self.are_seen(scan, middle, b, depth);
        self.is_seen(scan, a, b) && (depth == 0 || halves(depth - 1))
    }

    fn is_seen(&self, scan: &Scan<'_>, a: f64, b: f64) -> bool {
        let whole = self.sizes[self.sizes.len() - 1];
        let (first, last) = (self.panel(a), self.panel(b.next_down()));
        let mut sizes: [f64; 3] = std::array::from_fn(|k| self.sizes[last][k] - self.sizes[first][k]);
        if last - first < 2 {
            sizes = scan.sizes(1, a, b);
        }
        let end = |t: f64| scan.program.eval(t).0;
        let (start, end) = (end(a), end(b.next_down()));
        let exact = [
            self.integral(scan.program, b.next_down()) - self.integral(scan.program, a),
            end.value - start.value,
            end.rate - start.rate,
        ];
        let mut found = [0.0; 3];
        for (t, w) in scan.rules[0].on(a, b) {
            let values = parts(scan.program.eval(t).0);
            found.iter_mut().zip(values).for_each(|(found, y)| *found += w * y);
        }
        let found_sizes = scan.sizes(0, a, b);
        (0..3).all(|k| {
            let size = sizes[k].max(found_sizes[k]);
            let (local, global) = SEEN;
            size <= global * whole[k]
                || !(size.is_finite() && exact[k].is_finite())
                || (found[k] - exact[k]).abs() <= local * size && found_sizes[k] >= 0.3 * size
        })
    }
}

/// f, f′ and f″.
fn parts(jet: Jet) -> [f64; 3] {
    [jet.value, jet.rate, jet.bend]
}

struct Scan<'a> {
    program: &'a Program,
    extent: f64,
    /// Three points, as a step has, and the rule of a panel.
    rules: [Gauss; 2],
    /// ∫|f| over the range, as far as it is known.
    total: f64,
}

impl Scan<'_> {
    fn panels(&self) -> Result<Panels, Refused> {
        let mut panels = Panels {
            grid: vec![0.0],
            sums: vec![0.0],
            sizes: vec![[0.0; 3]],
            gauss: self.rules[1].clone(),
            breaks: Vec::new(),
            resolution: Vec::new(),
            doubtful: Vec::new(),
        };
        self.visit(0.0, self.extent, 0, &mut panels)?;
        // What lies in the edges between panels.
        let edge = EDGE * self.extent;
        for t in &mut panels.grid[1..] {
            let mut from = (*t - edge).max(0.0);
            let to = (*t + edge).min(self.extent);
            while let Some(found) = first_change(self.program, from, to) {
                panels.breaks.push(found);
                (*t, from) = (found, found);
            }
        }
        panels.breaks.extend(first_change(self.program, 0.0, edge));
        panels.breaks.sort_by(f64::total_cmp);
        panels.breaks.dedup();
        let whole = panels.sizes[panels.sizes.len() - 1][0];
        match panels.doubtful.iter().find(|(_, size)| *size > POLE * whole) {
            Some((at, _)) => Err(Refused::Pole(*at)),
            None => Ok(panels),
        }
    }

    fn visit(&self, a: f64, b: f64, depth: u32, out: &mut Panels) -> Result<(), Refused> {
        let (width, edge) = (b - a, EDGE * self.extent);
        let split = |out: &mut Panels| {
            let middle = 0.5 * (a + b);
            self.visit(a, middle, depth + 1, out)?;
            self.visit(middle, b, depth + 1, out)
        };
        let last = width <= SHORTEST * self.extent;
        if depth < LEAST_DEPTH {
            return split(out);
        }
        let inside = if last { 0.25 * width } else { edge };
        let (bounds, decided) = self.program.bounds(a + inside, b - inside);
        if !(decided || last) {
            if depth >= BISECTION_DEPTH
                && let Some(found) = first_change(self.program, a, b.next_down())
                && found - a > SHORTEST * self.extent
                && b - found > SHORTEST * self.extent
            {
                self.visit(a, found, depth + 1, out)?;
                return self.visit(found, b, depth + 1, out);
            }
            return split(out);
        }
        // The bounds of a shortest panel leave out more than the edges that are searched.
        if last && let Some(found) = first_change(self.program, a, b.next_down()) {
            self.panel(a, found, bounds, true, out)?;
            return self.panel(found, b, bounds, true, out).map(|_| ());
        }
        if self.panel(a, b, bounds, last, out)? { Ok(()) } else { split(out) }
    }

    /// Adds the panel, if samples show all of it or it is the `last` one.
    fn panel(&self, a: f64, b: f64, bounds: Interval, last: bool, out: &mut Panels) -> Result<bool, Refused> {
        if a >= b {
            return Ok(true);
        }
        let middle = 0.5 * (a + b);
        let ends = [self.finite(a)?.value, self.finite(b.next_down())?.value];
        let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
        let beyond = |low: f64, high: f64, (least, largest): (f64, f64)| {
            (b - a) * (high - largest).max(least - low).max(0.0)
        };
        // What three values leave open decides most panels.
        let y = self.program.value(middle);
        let open = beyond(bounds.low, bounds.high, (low.min(y), high.max(y)));
        let most = (b - a) * bounds.high.abs().max(bounds.low.abs());
        if !last && open > 3.0 * (ROOM.0 * most + ROOM.1 * self.total) {
            return Ok(false);
        }
        let rule = &self.rules[1];
        let (mut halves, mut sizes) = (0.0, [0.0; 3]);
        let (mut least, mut largest) = (f64::INFINITY, f64::NEG_INFINITY);
        for (t, w) in rule.on(a, middle).chain(rule.on(middle, b)) {
            let jet = self.finite(t)?;
            halves += w * jet.value;
            for (size, y) in sizes.iter_mut().zip(parts(jet)) {
                *size += w * y.abs();
            }
            (least, largest) = (least.min(jet.value), largest.max(jet.value));
        }
        let whole = rule.integrate(a, b, |t| self.program.value(t));
        let room = 0.01 * beyond(low, high, (least, largest))
            + beyond(bounds.low, bounds.high, (least.min(low), largest.max(high)));
        let noise = self.program.bounds(middle.next_down(), middle.next_up()).0;
        let noise = (b - a) * (noise.high - noise.low);
        let good = room <= ROOM.0 * sizes[0] + ROOM.1 * self.total + noise
            && (whole - halves).abs() <= TOLERANCE * sizes[0].max(self.total / 64.0) + noise;
        if !(good || last) {
            return Ok(false);
        }
        if !good {
            out.doubtful.push((a, sizes[0]));
        }
        if out.grid.len() > MOST {
            return Err(Refused::TooFast);
        }
        let i = out.grid.len() - 1;
        out.grid.push(b);
        out.sums.push(out.sums[i] + halves);
        out.sizes.push(std::array::from_fn(|k| out.sizes[i][k] + sizes[k]));
        Ok(true)
    }

    /// ∫ of |f|, |f′| and |f″| from a to b by a rule.
    fn sizes(&self, rule: usize, a: f64, b: f64) -> [f64; 3] {
        let mut sizes = [0.0; 3];
        for (t, w) in self.rules[rule].on(a, b) {
            let values = parts(self.program.eval(t).0);
            sizes.iter_mut().zip(values).for_each(|(size, y)| *size += w * y.abs());
        }
        sizes
    }

    fn finite(&self, t: f64) -> Result<Jet, Refused> {
        let jet = self.program.eval(t).0;
        if jet.value.is_finite() { Ok(jet) } else { Err(Refused::NotFinite(jet.value, t)) }
    }
}

/// The first double after `from` on which the branch differs from that of `from`, if that of `to` does.
fn first_change(program: &Program, from: f64, to: f64) -> Option<f64> {
    let start = program.eval(from).1;
    if start == program.eval(to).1 {
        return None;
    }
    let (mut same, mut other) = (from, to);
    loop {
        let middle = 0.5 * (same + other);
        if middle <= same || middle >= other {
            return Some(other);
        }
        if program.eval(middle).1 == start { same = middle } else { other = middle }
    }
}
