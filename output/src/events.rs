//! `events.csv`: impacts of a run, and contacts that close, open, slip or stick.

use super::csv::io_error;
use flexion::analysis::transient::{Event, EventKind};
use flexion::contact::Neglected;
use flexion::system::{Mode, State, System, Touch};
use serde_json::{Value, json};
use std::io::{self, Write};

/// Impulse over the largest of the run below which it is rounding.
const ROUNDING: f64 = 1e-12;
/// Rows of the list that a summary shows at either end.
const SHOWN: usize = 5;

/// What happened at a contact.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Time t \[s\].
    pub time: f64,
    /// Number of the contact.
    pub contact: usize,
    /// What happened: `impact`, `closed`, `opened`, `slips`, `sticks`; `touched` and `left` of a continuous force.
    pub what: &'static str,
    /// Impulse of the normal force [N·s].
    pub impulse: f64,
    /// Impulse of the friction [N·s].
    pub friction: f64,
    /// Closing speed −ġ before an impact [m/s].
    pub speed: f64,
    /// Effective mass 1/(G M⁻¹ Gᵀ) of the contact by itself \[kg\].
    pub mass: f64,
    /// Energy lost in all impacts of this time \[J\], in the row of the first.
    pub lost: f64,
}

/// The events of a run at its contacts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Events {
    contacts: Vec<Touch>,
    modes: Vec<Mode>,
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
        Events { contacts: system.contacts(state), modes: state.mode.clone(), ..Events::default() }
    }

    /// Whether the system has no contacts.
    pub fn is_empty(&self) -> bool {
        self.contacts.is_empty()
    }

    /// Name of contact `i`.
    pub fn name(&self, i: usize) -> &str {
        self.contacts.get(i).map_or("", |contact| contact.name.as_str())
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

    /// Adds an event.
    pub(super) fn add(&mut self, event: &Event) {
        let blank = Entry {
            time: event.time,
            contact: 0,
            what: "impact",
            impulse: 0.0,
            friction: 0.0,
            speed: 0.0,
            mass: 0.0,
            lost: 0.0,
        };
        let mut open = 0.0;
        if let EventKind::Impact { lost, impulses, .. } = &event.kind {
            open = *lost;
            self.strongest = impulses.iter().fold(self.strongest, |m, x| m.max(x.abs()));
        }
        let least = ROUNDING * self.strongest;
        for (i, contact) in self.contacts.iter_mut().enumerate() {
            let mut push = |entry: Entry| self.list.push(Entry { contact: i, ..entry });
            match (&event.kind, contact.row, contact.indicator) {
                (EventKind::Impact { impulses, rates, masses, .. }, Some(row), _)
                    if impulses[row] > least =>
                {
                    let friction = match &impulses[contact.friction.clone()] {
                        [one] => *one,
                        more => more.iter().map(|x| x * x).sum::<f64>().sqrt(),
                    };
                    let (impulse, speed, mass) = (impulses[row], -rates[row], masses[row]);
                    push(Entry { impulse, friction, speed, mass, lost: open, ..blank });
                    open = 0.0;
                }
                (EventKind::Crossing { indicators }, _, Some(own)) if indicators.contains(&own) => {
                    contact.gap = -contact.gap;
                    let what = if contact.gap < 0.0 { "touched" } else { "left" };
                    push(Entry { what, ..blank });
                }
                _ => {}
            }
            let friction = contact.friction.clone().next();
            for (row, what) in [(contact.row, ["closed", "opened"]), (friction, ["sticks", "slips"])] {
                let Some(row) = row else { continue };
                let (before, now) = (self.modes[row], event.modes[row]);
                let open = contact.row.is_some_and(|row| event.modes[row] == Mode::Open);
                if before != now && !(open && friction == Some(row)) {
                    push(Entry { what: what[usize::from(now != Mode::Closed)], ..blank });
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

    /// Energy lost in impacts \[J\].
    pub fn lost(&self) -> f64 {
        self.list.iter().map(|entry| entry.lost).sum()
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
    ];
    csv.write_record(head).map_err(io_error)?;
    for e in &events.list {
        let [time, impulse, friction, speed, mass, lost] =
            [e.time, e.impulse, e.friction, e.speed, e.mass, e.lost].map(|x| format!("{x:?}"));
        let row = [&time, events.name(e.contact), e.what, &impulse, &friction, &speed, &mass, &lost];
        csv.write_record(row).map_err(io_error)?;
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
        events.add(&Event { time: 0.6, kind: crossing(), modes: modes.clone() });
        events.add(&Event { time: 0.7, kind: crossing(), modes });
        events.add(&Event { time: 0.8, kind: EventKind::Switch, modes: vec![Mode::Open; 4] });
        let rows: Vec<String> = text(&events).lines().skip(1).map(str::to_owned).collect();
        assert_eq!(
            rows,
            [
                "0.5,a,impact,0.5,-0.1,3.0,0.2,2.0",
                "0.5,b,impact,0.25,0.0,4.0,0.1,0.0",
                "0.5,b,closed,0.0,0.0,0.0,0.0,0.0",
                "0.5,b,slips,0.0,0.0,0.0,0.0,0.0",
                "0.6,c,touched,0.0,0.0,0.0,0.0,0.0",
                "0.7,c,left,0.0,0.0,0.0,0.0,0.0",
                "0.8,b,opened,0.0,0.0,0.0,0.0,0.0",
            ]
        );
        assert_eq!((events.impacts().count(), events.lost()), (3, 2.0));
        let json = events.to_json();
        assert_eq!((json["first"].as_array().unwrap().len(), json["last"].as_array().unwrap().len()), (5, 2));
    }
}
