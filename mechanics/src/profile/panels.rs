//! A formula, seen everywhere: where it breaks, its integral to a checked error, and where steps must end to see it.
//!
//! The range is halved until, in each panel,
//!
//! - [bounds](super::interval) of the values leave no room for what samples miss, to a tenth of ∫|f| there or 10⁻⁷ of
//!   that over the whole range, and decide all comparisons in one way;
//! - two Gauss rules, over the panel and over its halves, differ by less than 10⁻¹³ of these, or by rounding.
//!
//! Changes of branch are located by bisection. Halving ends at 10⁻⁹ of the time itself, however long the range is: what counts there and is
//! not integrated is a pole, or shorter than that, and refused; infinite slopes and kinks that no comparison shows do not count.

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
/// Shortest panel, and what is left out at its ends where comparisons are decided, over its time, or over `EARLIEST` of the range.
const SHORTEST: f64 = 1e-9;
const EDGE: f64 = 1e-10;
const EARLIEST: f64 = 1e-9;
/// Largest numbers of panels, and of times at which steps end.
const MOST: usize = 1 << 17;
const MOST_TIMES: usize = 1 << 18;
/// Tolerance of the integral, over ∫|f|.
const TOLERANCE: f64 = 1e-13;
/// Room for values that samples have not shown: over ∫|f| in the panel, and over the whole range; part of the range in which the latter falls
/// with the time.
const ROOM: (f64, f64) = (0.1, 1e-7);
const EARLY: f64 = 1e-3;
/// Part of ∫|f| that counts where a shortest panel does not show it.
const COUNTS: f64 = 1e-3;
/// What three points may miss between two neighbouring times of the resolution: of ∫|f| there, and of the whole, or of f there where it is
/// what f′ and f″ change there.
const SEEN: (f64, f64) = (0.05, 1e-6);

/// Why a formula is refused.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Refused {
    /// It is this, no finite number, at this time.
    NotFinite(f64, f64),
    /// It grows beyond all bounds near this time.
    Pole(f64),
    /// It varies within less than the shortest panel, `within`, near the time `at`.
    TooShort { at: f64, within: f64 },
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
    /// Shortest panels that are not integrated to the tolerance.
    doubtful: Vec<Doubtful>,
}

/// A shortest panel that is not integrated to the tolerance.
#[derive(Clone, Copy, Debug)]
struct Doubtful {
    start: f64,
    width: f64,
    /// ∫|f| as far as samples or bounds show it.
    size: f64,
    bounded: bool,
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
            panels.resolve(&scan, part[0], part[1], &mut resolution)?;
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
    fn resolve(&self, scan: &Scan<'_>, a: f64, b: f64, out: &mut Vec<f64>) -> Result<(), Refused> {
        if b - a > scan.shortest(b) && !self.are_seen(scan, a, b, 2) {
            if out.len() >= MOST_TIMES {
                return Err(Refused::TooFast);
            }
            let middle = middle(a, b);
            self.resolve(scan, a, middle, out)?;
            out.push(middle);
            self.resolve(scan, middle, b, out)?;
        }
        Ok(())
    }

    /// Whether three points see it from a to b, and in the halves of that: fast waves may seem to be seen by chance.
    fn are_seen(&self, scan: &Scan<'_>, a: f64, b: f64, depth: u32) -> bool {
        let middle = middle(a, b);
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
        let mut change = 1.0;
        (0..3).all(|k| {
            let size = sizes[k].max(found_sizes[k]);
            let (local, global) = SEEN;
            let of_value = k > 0 && change * size <= global * sizes[0];
            change *= b - a;
            size <= global * whole[k]
                || of_value
                || !(size.is_finite() && exact[k].is_finite())
                || (found[k] - exact[k]).abs() <= local * size && found_sizes[k] >= 0.3 * size
        })
    }
}

/// ½ (a + b), also where the sum is no double.
fn middle(a: f64, b: f64) -> f64 {
    0.5 * a + 0.5 * b
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
        for t in &mut panels.grid {
            let edge = self.edge(*t);
            let mut from = (*t - edge).max(0.0);
            let to = (*t + edge).min(self.extent);
            panels.doubtful.extend(self.hidden(from, to));
            while let Some(found) = first_change(self.program, from, to) {
                panels.breaks.push(found);
                from = found;
                if *t > 0.0 {
                    *t = found;
                }
            }
        }
        panels.breaks.sort_by(f64::total_cmp);
        panels.breaks.dedup();
        let whole = panels.sizes[panels.sizes.len() - 1][0];
        match panels.doubtful.iter().find(|panel| panel.size > COUNTS * whole) {
            Some(Doubtful { start, bounded: false, .. }) => Err(Refused::Pole(*start)),
            Some(Doubtful { start, width, .. }) => Err(Refused::TooShort { at: *start, within: *width }),
            None => Ok(panels),
        }
    }

    /// What bounds allow between two times, and the values there do not show.
    fn hidden(&self, from: f64, to: f64) -> Option<Doubtful> {
        let Interval { low, high } = self.program.bounds(from, to).0;
        let [a, b] = [from, to].map(|t| self.program.value(t));
        let size = (to - from) * (high - a.max(b)).max(a.min(b) - low);
        let found = Doubtful { start: from, width: to - from, size, bounded: true };
        (size > 0.0 && low.is_finite() && high.is_finite()).then_some(found)
    }

    /// The shortest panel that ends at t.
    fn shortest(&self, t: f64) -> f64 {
        SHORTEST * t.max(EARLIEST * self.extent)
    }

    /// What is left out at t.
    fn edge(&self, t: f64) -> f64 {
        EDGE * t.max(EARLIEST * self.extent)
    }

    fn visit(&self, a: f64, b: f64, depth: u32, out: &mut Panels) -> Result<(), Refused> {
        let (width, shortest) = (b - a, self.shortest(b));
        let split = |out: &mut Panels| {
            let middle = middle(a, b);
            self.visit(a, middle, depth + 1, out)?;
            self.visit(middle, b, depth + 1, out)
        };
        let last = width <= shortest;
        if depth < LEAST_DEPTH {
            return split(out);
        }
        if last {
            // No more than the ends are searched for a change of branch here.
            let found = first_change(self.program, a, b.next_down()).unwrap_or(a);
            for (a, b) in [(a, found), (found, b)] {
                self.panel(a, b, self.program.bounds(a, b.next_down()).0, true, out)?;
            }
            return Ok(());
        }
        let (bounds, decided) = self.program.bounds(a + self.edge(a), b - self.edge(b));
        if !decided {
            if depth >= BISECTION_DEPTH
                && let Some(found) = first_change(self.program, a, b.next_down())
                && found - a > shortest
                && b - found > shortest
            {
                self.visit(a, found, depth + 1, out)?;
                return self.visit(found, b, depth + 1, out);
            }
            return split(out);
        }
        if self.panel(a, b, bounds, false, out)? { Ok(()) } else { split(out) }
    }

    /// Adds the panel, if samples show all of it or it is the `last` one.
    fn panel(&self, a: f64, b: f64, bounds: Interval, last: bool, out: &mut Panels) -> Result<bool, Refused> {
        if a >= b {
            return Ok(true);
        }
        // As far as it is known: a function that has decayed counts as nothing from here on.
        let total = self.total.max(out.sizes[out.sizes.len() - 1][0]);
        let middle = middle(a, b);
        let ends = [self.finite(a)?.value, self.finite(b.next_down())?.value];
        let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
        let beyond =
            |least: f64, largest: f64| (b - a) * (bounds.high - largest).max(least - bounds.low).max(0.0);
        let noise = || {
            let noise = self.program.bounds(middle.next_down(), middle.next_up()).0;
            (b - a) * (noise.high - noise.low)
        };
        // What three values leave open decides most panels.
        let y = self.program.value(middle);
        let open = beyond(low.min(y), high.max(y));
        let little = ROOM.1 * total * (b / (EARLY * self.extent)).min(1.0);
        let most = (b - a) * bounds.high.abs().max(bounds.low.abs());
        if !last && open > 3.0 * (ROOM.0 * most + little) && open > 3.0 * noise() {
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
        // The ends do not count: a pulse may have its crest there.
        let (room, noise) = (beyond(least, largest), noise());
        let good = room <= ROOM.0 * sizes[0] + little + noise
            && (whole - halves).abs() <= TOLERANCE * sizes[0].max(total / 64.0) + noise;
        if !(good || last) {
            return Ok(false);
        }
        if !good {
            let Interval { low, high } = self.program.bounds(a, b).0;
            let bounded = low.is_finite() && high.is_finite();
            let size = if bounded { sizes[0].max(room) } else { sizes[0] };
            out.doubtful.push(Doubtful { start: a, width: b - a, size, bounded });
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
        let middle = middle(same, other);
        if middle <= same || middle >= other {
            return Some(other);
        }
        if program.eval(middle).1 == start { same = middle } else { other = middle }
    }
}
