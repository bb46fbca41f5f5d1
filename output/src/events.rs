//! `events.csv`: impacts of a run, and contacts that close, open, slip or stick.

use super::csv::io_error;
use super::passing::vertex;
use flexion::analysis::transient::{Event, EventKind};
use flexion::contact::Neglected;
use flexion::system::{Mode, Pressing, State, System, Touch};
use serde_json::{Value, json};
use std::io::{self, Write};

/// Impulse over the largest of the run below which it is rounding.
const ROUNDING: f64 = 1e-12;
/// Rows of the list that a summary shows at either end.
const SHOWN: usize = 5;

/// What happened at a contact. `None` stands for what does not apply or is not known.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Entry {
    /// Time t \[s\].
    pub time: f64,
    /// Number of the contact.
    pub contact: usize,
    /// What happened: `impact`, `closed`, `opened`, `slips`, `sticks`; `touched` and `left` of a continuous force.
    pub what: &'static str,
    /// Impulse of the normal force [N·s]: of an impact, or ∫F dt of a continuous force that has left.
    pub impulse: Option<f64>,
    /// Impulse of the friction in an impact [N·s].
    pub friction: Option<f64>,
    /// Closing speed −ġ before an impact or at a touch [m/s].
    pub speed: Option<f64>,
    /// Effective mass 1/(G M⁻¹ Gᵀ) of the contact by itself \[kg\].
    pub mass: Option<f64>,
    /// Energy lost \[J\]: in all impacts of this time, in the row of the first, or by a continuous force since it touched.
    pub lost: Option<f64>,
    /// Time since the touch, of a continuous force that has left \[s\].
    pub duration: Option<f64>,
    /// Its largest value \[N\].
    pub force: Option<f64>,
    /// Largest indentation since the touch \[m\].
    pub indentation: Option<f64>,
    /// Where the point is, in the axes in which its obstacle is given \[m\].
    pub place: Option<[f64; 3]>,
}

impl Entry {
    /// Impulse times closing speed \[J\], 0 where one of them does not apply.
    pub fn work(&self) -> f64 {
        self.impulse.unwrap_or(0.0) * self.speed.unwrap_or(0.0)
    }
}

/// What a continuous force has done since its contact touched.
#[derive(Clone, Debug, Default, PartialEq)]
struct Burst {
    /// When it touched; `None` where it did before the run began.
    since: Option<f64>,
    /// ∫F dt [N·s]
    impulse: f64,
    lost: f64,
    force: Largest,
    indentation: Largest,
}

/// Largest of a quantity, also between the values that are seen.
#[derive(Clone, Debug, Default, PartialEq)]
struct Largest {
    value: f64,
    last: [(f64, f64); 3],
    count: usize,
}

impl Largest {
    fn enter(&mut self, t: f64, y: f64) {
        self.value = self.value.max(y);
        if self.count > 0 && t <= self.last[2].0 {
            return;
        }
        self.last.rotate_left(1);
        self.last[2] = (t, y);
        self.count += 1;
        if self.count > 2
            && let Some((_, y)) = vertex(self.last)
        {
            self.value = self.value.max(y);
        }
    }
}

/// The events of a run at its contacts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Events {
    contacts: Vec<Touch>,
    modes: Vec<Mode>,
    /// What presses at the state passed last, and work memory.
    pressing: Vec<Pressing>,
    inside: Vec<Pressing>,
    /// Of each contact.
    bursts: Vec<Burst>,
    /// Largest impulse [N·s].
    strongest: f64,
    /// What happened, in order of time.
    pub list: Vec<Entry>,
    /// Bounds of what bounces that were not followed would have done.
    pub neglected: Neglected,
}

impl Events {
    /// None yet, of a run that begins with `state`.
    pub fn new(system: &mut dyn System, state: &State) -> Events {
        let contacts = system.contacts(state);
        let mut pressing = Vec::new();
        system.pressing(state, &mut pressing);
        Events {
            bursts: vec![Burst::default(); contacts.len()],
            inside: pressing.clone(),
            pressing,
            contacts,
            modes: state.mode.clone(),
            ..Events::default()
        }
    }

    /// Whether the system has no contacts.
    pub fn is_empty(&self) -> bool {
        self.contacts.is_empty()
    }

    /// Name of contact `i`.
    pub fn name(&self, i: usize) -> &str {
        self.contacts.get(i).map_or("", |contact| contact.name.as_str())
    }

    /// Names of the contacts.
    pub(super) fn names(&self) -> impl Iterator<Item = &str> {
        self.contacts.iter().map(|contact| contact.name.as_str())
    }

    /// Name of the contact with this row.
    pub(super) fn name_of_row(&self, row: usize) -> &str {
        let found = self.contacts.iter().find(|contact| contact.row == Some(row));
        found.map_or("", |contact| contact.name.as_str())
    }

    /// The impacts, and the beginnings of continuous forces.
    pub fn impacts(&self) -> impl Iterator<Item = &Entry> {
        self.list.iter().filter(|entry| matches!(entry.what, "impact" | "touched"))
    }

    /// Takes the modes of a state before the first event.
    pub(super) fn begin(&mut self, state: &State) {
        if self.list.is_empty() {
            self.modes.copy_from_slice(&state.mode);
        }
    }

    /// Whether a continuous force may press: states inside the steps are integrated over.
    pub(super) fn touching(&self) -> bool {
        self.contacts.iter().any(|contact| contact.indicator.is_some() && contact.gap < 0.0)
    }

    /// Takes a state inside a step with its weight in an integral over time \[s\].
    pub(super) fn within(&mut self, system: &mut dyn System, state: &State, weight: f64) {
        system.pressing(state, &mut self.inside);
        for ((contact, now), burst) in self.contacts.iter().zip(&self.inside).zip(&mut self.bursts) {
            if contact.indicator.is_some() && contact.gap < 0.0 {
                burst.impulse += weight * now.force;
                burst.lost += weight * now.lost;
                burst.enter(state.t, now);
            }
        }
    }

    /// Takes the end of a step.
    pub(super) fn pass(&mut self, system: &mut dyn System, state: &State) {
        if self.is_empty() {
            return;
        }
        system.pressing(state, &mut self.pressing);
        for ((contact, now), burst) in self.contacts.iter().zip(&self.pressing).zip(&mut self.bursts) {
            if contact.indicator.is_some() && contact.gap < 0.0 {
                burst.enter(state.t, now);
            }
        }
    }

    /// Adds an event.
    pub(super) fn add(&mut self, event: &Event) {
        let (time, mut open) = (event.time, None);
        if let EventKind::Impact { lost, impulses, .. } = &event.kind {
            open = Some(*lost);
            self.strongest = impulses.iter().fold(self.strongest, |m, x| m.max(x.abs()));
        }
        let least = ROUNDING * self.strongest;
        for (i, contact) in self.contacts.iter_mut().enumerate() {
            let now = self.pressing.get(i).copied();
            let place = now.map(|now| now.place);
            let mut push = |entry: Entry| self.list.push(Entry { time, contact: i, place, ..entry });
            match (&event.kind, contact.row, contact.indicator) {
                (EventKind::Impact { impulses, rates, masses, .. }, Some(row), _)
                    if impulses[row] > least =>
                {
                    let friction = match &impulses[contact.friction.clone()] {
                        [] => None,
                        [one] => Some(*one),
                        more => Some(more.iter().map(|x| x * x).sum::<f64>().sqrt()),
                    };
                    push(Entry {
                        what: "impact",
                        impulse: Some(impulses[row]),
                        friction,
                        speed: Some(-rates[row]),
                        mass: Some(masses[row]).filter(|mass| *mass > 0.0),
                        lost: open.take(),
                        ..Entry::default()
                    });
                }
                (EventKind::Crossing { indicators }, _, Some(own)) if indicators.contains(&own) => {
                    contact.gap = -contact.gap;
                    let burst = &mut self.bursts[i];
                    if contact.gap < 0.0 {
                        *burst = Burst { since: Some(time), ..Burst::default() };
                        let speed = now.map(|now| -now.rate);
                        push(Entry { what: "touched", speed, ..Entry::default() });
                    } else {
                        let known = |x: f64| burst.since.map(|_| x);
                        push(Entry {
                            what: "left",
                            impulse: known(burst.impulse),
                            lost: Some(burst.lost),
                            duration: burst.since.map(|since| time - since),
                            force: known(burst.force.value),
                            indentation: known(burst.indentation.value),
                            ..Entry::default()
                        });
                        *burst = Burst::default();
                    }
                }
                _ => {}
            }
            let friction = contact.friction.clone().next();
            for (row, what) in [(contact.row, ["closed", "opened"]), (friction, ["sticks", "slips"])] {
                let Some(row) = row else { continue };
                let (before, now) = (self.modes[row], event.modes[row]);
                let open = contact.row.is_some_and(|row| event.modes[row] == Mode::Open);
                if before != now && !(open && friction == Some(row)) {
                    push(Entry { what: what[usize::from(now != Mode::Closed)], ..Entry::default() });
                }
            }
        }
        self.modes.copy_from_slice(&event.modes);
    }

    /// Number of impacts, energy lost in them, and the first and last events, for a summary.
    pub fn to_json(&self) -> Value {
        let entry = |e: &Entry| {
            json!({
                "time": e.time, "contact": self.name(e.contact), "event": e.what, "impulse": e.impulse,
                "friction": e.friction, "closing_speed": e.speed, "effective_mass": e.mass, "energy_lost": e.lost,
                "duration": e.duration, "largest_force": e.force, "largest_indentation": e.indentation, "place": e.place,
            })
        };
        let (n, list) = (self.list.len(), &self.list);
        let Neglected { count, time, gap, energy } = self.neglected;
        json!({
            "count": n,
            "impacts": self.impacts().count(),
            "energy_lost_in_impacts": self.lost(),
            "first": list[..n.min(SHOWN)].iter().map(entry).collect::<Vec<_>>(),
            "last": list[n.saturating_sub(SHOWN).max(n.min(SHOWN))..].iter().map(entry).collect::<Vec<_>>(),
            "bounces_not_followed": { "contacts": count, "time": time, "gap": gap, "energy": energy },
        })
    }

    /// Energy lost in impacts and in continuous forces \[J\], those that still press too.
    pub fn lost(&self) -> f64 {
        let listed: f64 = self.list.iter().filter_map(|entry| entry.lost).sum();
        listed + self.bursts.iter().map(|burst| burst.lost).sum::<f64>()
    }
}

impl Burst {
    fn enter(&mut self, t: f64, now: &Pressing) {
        self.force.enter(t, now.force);
        self.indentation.enter(t, -now.gap);
    }
}

/// Writes the events as comma-separated values, one line each.
///
/// # Errors
/// Whatever `to` returns.
pub fn write_events(events: &Events, to: impl Write) -> io::Result<()> {
    let mut csv = ::csv::Writer::from_writer(to);
    let head = [
        "time [s]",
        "contact",
        "event",
        "impulse [N*s]",
        "friction impulse [N*s]",
        "closing speed [m/s]",
        "effective mass [kg]",
        "energy lost [J]",
        "duration [s]",
        "largest force [N]",
        "largest indentation [m]",
        "x [m]",
        "y [m]",
        "z [m]",
    ];
    csv.write_record(head).map_err(io_error)?;
    for e in &events.list {
        let mut row = vec![format!("{:?}", e.time), events.name(e.contact).to_owned(), e.what.to_owned()];
        let quantities = [e.impulse, e.friction, e.speed, e.mass, e.lost, e.duration, e.force, e.indentation];
        let place = [0, 1, 2].map(|i| e.place.map(|place| place[i]));
        let text = |x: Option<f64>| x.map(|x| format!("{x:?}")).unwrap_or_default();
        row.extend(quantities.into_iter().chain(place).map(text));
        csv.write_record(&row).map_err(io_error)?;
    }
    csv.flush()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn touch(name: &str, row: Option<usize>, indicator: Option<usize>) -> Touch {
        let friction = row.map_or(0..0, |row| row + 1..row + 2);
        Touch { name: name.into(), row, friction, indicator, gap: 1.0, rate: 0.0 }
    }

    fn text(events: &Events) -> String {
        let mut out = Vec::new();
        write_events(events, &mut out).unwrap();
        String::from_utf8(out).unwrap()
    }

    #[test]
    fn an_impact_is_one_row_for_each_contact_that_it_strikes_and_its_energy_counts_once() {
        let contacts = vec![touch("a", Some(0), None), touch("b", Some(2), None), touch("c", None, Some(0))];
        let mut events = Events { contacts, modes: vec![Mode::Open; 4], ..Events::default() };
        let kind = EventKind::Impact {
            impulses: vec![0.5, -0.1, 0.25, 0.0],
            lost: 2.0,
            rates: vec![-3.0, 1.0, -4.0, 0.0],
            masses: vec![0.2, 0.0, 0.1, 0.0],
        };
        let modes = vec![Mode::Open, Mode::Open, Mode::Closed, Mode::SlipForward];
        events.add(&Event { time: 0.5, kind, modes: modes.clone() });
        let crossing = || EventKind::Crossing { indicators: vec![0] };
        let at = |gap: f64, rate, force| Pressing { place: [1.0, gap, 0.0], gap, rate, force, lost: 0.0 };
        events.bursts = vec![Burst::default(); 3];
        events.pressing = vec![at(0.0, 0.0, 0.0), at(0.0, 0.0, 0.0), at(0.0, -2.0, 0.0)];
        events.add(&Event { time: 0.6, kind: crossing(), modes: modes.clone() });
        assert!(events.touching());
        // The parabola through 1, 4 and 3 has its vertex 4.125 between them.
        for (t, x) in [(0.25, 1.0), (0.5, 4.0), (0.75, 3.0)] {
            events.bursts[2].enter(t, &at(-x, 0.0, 2.0 * x));
        }
        (events.bursts[2].impulse, events.bursts[2].lost) = (0.5, 0.25);
        events.add(&Event { time: 0.7, kind: crossing(), modes });
        events.add(&Event { time: 0.8, kind: EventKind::Switch, modes: vec![Mode::Open; 4] });
        let rows: Vec<String> = text(&events).lines().skip(1).map(str::to_owned).collect();
        assert_eq!(
            rows,
            [
                "0.5,a,impact,0.5,-0.1,3.0,0.2,2.0,,,,,,",
                "0.5,b,impact,0.25,0.0,4.0,0.1,,,,,,,",
                "0.5,b,closed,,,,,,,,,,,",
                "0.5,b,slips,,,,,,,,,,,",
                "0.6,c,touched,,,2.0,,,,,,1.0,0.0,0.0",
                "0.7,c,left,0.5,,,,0.25,0.09999999999999998,8.25,4.125,1.0,0.0,0.0",
                "0.8,b,opened,,,,,,,,,1.0,0.0,0.0",
            ]
        );
        assert_eq!((events.impacts().count(), events.lost()), (3, 2.25));
        let json = events.to_json();
        assert_eq!((json["first"].as_array().unwrap().len(), json["last"].as_array().unwrap().len()), (5, 2));
    }
}
