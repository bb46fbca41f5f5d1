//! The events of a run at its contacts: impacts, contacts that close, open, slip or stick, forces that touch and leave, and bursts of impacts.

use super::rigid::{Burst, Closed, Rigid};
use super::trajectory::vertex;
use crate::analysis::transient::{Event, EventKind};
use crate::contact::Neglected;
use crate::integrator::{Checkpoint, NotResumed};
use crate::linalg::Vec3;
use crate::system::{ContactInfo, ContactSample, Mode, State, System};

/// Impulse over the largest of the run below which it is rounding.
const ROUNDING: f64 = 1e-12;

/// What happened at a contact. `None` stands for what does not apply or is not known.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Entry {
    /// Time t \[s\].
    pub time: f64,
    /// Number of the contact.
    pub contact: usize,
    /// What happened: `impact`, `closed`, `opened`, `slips`, `sticks`; `touched` and `left` of a continuous force; `burst` at the end of
    /// impacts and closures of a contact that follow each other within a recording interval.
    pub what: &'static str,
    /// Impulse of the normal force [N·s]: of an impact, ∫F dt of a continuous force that has left or of a contact that has opened, and of a whole
    /// burst.
    pub impulse: Option<f64>,
    /// Impulse of the friction in an impact [N·s].
    pub friction: Option<f64>,
    /// Closing speed −ġ before an impact or at a touch [m/s].
    pub speed: Option<f64>,
    /// Effective mass 1/(G M⁻¹ Gᵀ) of the contact by itself \[kg\].
    pub mass: Option<f64>,
    /// Energy lost \[J\]: in all impacts of this time, in the row of the first, or by a continuous force since it touched.
    pub lost: Option<f64>,
    /// Time since the touch, of a continuous force that has left, or since it closed \[s\]; of a burst from its first impact to its end.
    pub duration: Option<f64>,
    /// Its largest value \[N\].
    pub force: Option<f64>,
    /// Largest indentation since the touch \[m\].
    pub indentation: Option<f64>,
    /// Where the point is, in the axes in which its obstacle is given \[m\].
    pub place: Option<Vec3>,
}

impl Entry {
    /// Impulse times closing speed \[J\], 0 where one of them does not apply.
    pub fn work(&self) -> f64 {
        self.impulse.unwrap_or(0.0) * self.speed.unwrap_or(0.0)
    }
}

/// What a continuous force has done since its contact touched.
#[derive(Clone, Debug, Default, PartialEq)]
struct Pressed {
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
    fn memory(&self) -> [f64; 8] {
        let [(t0, y0), (t1, y1), (t2, y2)] = self.last;
        [self.value, self.count.min(3) as f64, t0, y0, t1, y1, t2, y2]
    }

    fn of_memory(memory: &[f64]) -> Largest {
        let last = [2, 4, 6].map(|k| (memory[k], memory[k + 1]));
        Largest { value: memory[0], last, count: memory[1] as usize }
    }

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
    contacts: Vec<ContactInfo>,
    modes: Vec<Mode>,
    /// What presses at the state passed last, and work memory.
    samples: Vec<ContactSample>,
    inside: Vec<ContactSample>,
    /// Of each contact.
    pressed: Vec<Pressed>,
    /// Of each contact.
    rigid: Vec<Rigid>,
    /// Time between impacts of two bursts, at least \[s\].
    pub(super) apart: f64,
    /// Whether a multiplier is the impulse of its step over its size, as of methods in whose steps velocities jump.
    pub(super) by_step: bool,
    /// End of the step passed last \[s\].
    passed: f64,
    /// Whether a state has been shown, or the run goes on from one.
    begun: bool,
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
        let mut events = Events::of(system.contacts(state));
        system.contact_samples(state, &mut events.samples);
        events.inside.clone_from(&events.samples);
        events.modes.clone_from(&state.mode);
        events.passed = state.t;
        events
    }

    /// None yet, of these contacts.
    pub fn of(contacts: Vec<ContactInfo>) -> Events {
        let (pressed, rigid) =
            (vec![Pressed::default(); contacts.len()], vec![Rigid::default(); contacts.len()]);
        Events { pressed, rigid, contacts, ..Events::default() }
    }

    /// Whether the system has no contacts.
    pub fn is_empty(&self) -> bool {
        self.contacts.is_empty()
    }

    /// Whether a contact is rigid: its normal force is a multiplier.
    pub fn is_rigid(&self) -> bool {
        self.contacts.iter().any(|contact| contact.row.is_some())
    }

    /// Name of contact `i`.
    pub fn name(&self, i: usize) -> &str {
        self.contacts.get(i).map_or("", |contact| contact.name.as_str())
    }

    /// Names of the contacts.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.contacts.iter().map(|contact| contact.name.as_str())
    }

    /// Name of the contact with this row.
    pub(super) fn name_of_row(&self, row: usize) -> &str {
        let found = self.contacts.iter().find(|contact| contact.row == Some(row));
        found.map_or("", |contact| contact.name.as_str())
    }

    /// Energy \[J\] that an impact is said to add where contacts part at the start of its step and strike at its end: an error of a step that locates no impact.
    pub(super) fn parted(&self, impulses: &[f64], rates: &[f64]) -> f64 {
        let rows = self.contacts.iter().filter_map(|contact| contact.row);
        rows.map(|row| impulses[row] * rates[row].max(0.0)).sum()
    }

    /// The impacts, and the beginnings of continuous forces.
    pub fn impacts(&self) -> impl Iterator<Item = &Entry> {
        self.list.iter().filter(|entry| matches!(entry.what, "impact" | "touched"))
    }

    /// Names of the rigid contacts with their impulses over the whole run, ∫λ dt and those of impacts [N·s].
    pub fn impulses(&self) -> impl Iterator<Item = (&str, f64)> {
        let contacts = self.contacts.iter().zip(&self.rigid).filter(|(contact, _)| contact.row.is_some());
        contacts.map(|(contact, rigid)| (contact.name.as_str(), rigid.impulse))
    }

    /// Takes modes and forces of the first state that is shown.
    pub(super) fn begin(&mut self, state: &State) {
        if !std::mem::replace(&mut self.begun, true) {
            self.modes.copy_from_slice(&state.mode);
            for (contact, rigid) in self.contacts.iter().zip(&mut self.rigid) {
                let closed = contact.row.is_some_and(|row| state.mode[row] != Mode::Open);
                if closed && rigid.closed.is_none() {
                    rigid.closed = Some(Closed::default());
                }
                rigid.lambda = contact.row.map_or(0.0, |row| state.lambda[row]);
            }
        }
    }

    /// Whether a continuous force may press: states inside the steps are integrated over.
    pub(super) fn touching(&self) -> bool {
        self.contacts.iter().any(|contact| contact.indicator.is_some() && contact.gap < 0.0)
    }

    /// Takes a state inside a step with its weight in an integral over time \[s\].
    pub(super) fn within(&mut self, system: &mut dyn System, state: &State, weight: f64) {
        system.contact_samples(state, &mut self.inside);
        for ((contact, now), pressed) in self.contacts.iter().zip(&self.inside).zip(&mut self.pressed) {
            if contact.indicator.is_some() && contact.gap < 0.0 {
                pressed.impulse += weight * now.force;
                pressed.lost += weight * now.lost;
                pressed.enter(state.t, now);
            }
        }
    }

    /// Takes the end of a step.
    pub(super) fn pass(&mut self, system: &mut dyn System, state: &State) {
        if self.is_empty() {
            return;
        }
        let since = std::mem::replace(&mut self.passed, state.t);
        for i in 0..self.contacts.len() {
            let Some(row) = self.contacts[i].row else { continue };
            let (lambda, rigid) = (state.lambda[row].max(0.0), &mut self.rigid[i]);
            if self.by_step {
                let ended = rigid.push(lambda, [since, state.t], self.apart);
                ended.into_iter().for_each(|burst| self.close(i, &burst));
            } else {
                rigid.press(lambda, state.t - since);
            }
        }
        self.look(system, state);
    }

    /// Takes a state between the ends of a step.
    pub(super) fn look(&mut self, system: &mut dyn System, state: &State) {
        if self.is_empty() {
            return;
        }
        system.contact_samples(state, &mut self.samples);
        for ((contact, now), pressed) in self.contacts.iter().zip(&self.samples).zip(&mut self.pressed) {
            if contact.indicator.is_some() && contact.gap < 0.0 {
                pressed.enter(state.t, now);
            }
        }
    }

    /// Adds an event.
    pub(super) fn add(&mut self, event: &Event) {
        let (time, mut open, mut ended) = (event.time, None, Vec::new());
        if let EventKind::Impact { lost, impulses, .. } = &event.kind {
            open = Some(*lost);
            self.strongest = impulses.iter().fold(self.strongest, |m, x| m.max(x.abs()));
        }
        let (least, apart) = (ROUNDING * self.strongest, self.apart);
        for (i, contact) in self.contacts.iter_mut().enumerate() {
            let now = self.samples.get(i).copied();
            let place = now.map(|now| now.place);
            let rigid = &mut self.rigid[i];
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
                    if !self.by_step {
                        rigid.impulse += impulses[row];
                        ended.extend(rigid.add([time; 2], impulses[row], apart).map(|burst| (i, burst)));
                    }
                }
                (EventKind::Crossing { indicators }, _, Some(own)) if indicators.contains(&own) => {
                    // A gap at rest may have either sign within rounding.
                    contact.gap = match now {
                        Some(now) if now.rate != 0.0 => {
                            contact.gap.abs().max(f64::MIN_POSITIVE).copysign(now.rate)
                        }
                        _ => -contact.gap,
                    };
                    let pressed = &mut self.pressed[i];
                    if contact.gap < 0.0 {
                        *pressed = Pressed { since: Some(time), ..Pressed::default() };
                        let speed = now.map(|now| -now.rate);
                        push(Entry { what: "touched", speed, ..Entry::default() });
                    } else {
                        let known = |x: f64| pressed.since.map(|_| x);
                        push(Entry {
                            what: "left",
                            impulse: known(pressed.impulse),
                            lost: Some(pressed.lost),
                            duration: pressed.since.map(|since| time - since),
                            force: known(pressed.force.value),
                            indentation: known(pressed.indentation.value),
                            ..Entry::default()
                        });
                        *pressed = Pressed::default();
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
                    let mut entry =
                        Entry { what: what[usize::from(now != Mode::Closed)], ..Entry::default() };
                    if contact.row == Some(row) && now != Mode::Open {
                        rigid.closed = Some(Closed { since: Some(time), ..Closed::default() });
                    } else if let Some(closed) = rigid.closed.take_if(|_| contact.row == Some(row)) {
                        entry.duration = closed.since.map(|since| time - since);
                        entry.impulse = closed.since.map(|_| closed.impulse);
                        entry.force = closed.since.map(|_| closed.force);
                        let burst = rigid.add_closure(&closed, time, (apart, self.by_step));
                        ended.extend(burst.map(|burst| (i, burst)));
                    }
                    push(entry);
                }
            }
        }
        self.modes.copy_from_slice(&event.modes);
        ended.into_iter().for_each(|(i, burst)| self.close(i, &burst));
    }

    /// Adds what later events depend on to a checkpoint.
    pub(super) fn save(&self, out: &mut Checkpoint) {
        if self.is_empty() {
            return;
        }
        let modes: Vec<f64> = self.modes.iter().map(|mode| f64::from(*mode as u8)).collect();
        out.put("events.modes", &modes);
        out.put("events.strongest", &[self.strongest]);
        let gaps: Vec<f64> = self.contacts.iter().map(|contact| contact.gap).collect();
        out.put("events.gaps", &gaps);
        let rigid: Vec<f64> = self.rigid.iter().flat_map(Rigid::memory).collect();
        out.put("events.rigid", &rigid);
        let pressed: Vec<f64> = self.pressed.iter().flat_map(Pressed::memory).collect();
        out.put("events.pressed", &pressed);
    }

    /// Takes up what [`Events::save`] wrote, if anything: the events of a run that goes on are those of one that has never stopped.
    pub(super) fn resume(&mut self, from: &Checkpoint) -> Result<(), NotResumed> {
        self.begun = true;
        if self.is_empty() || from.list("events.modes").is_err() {
            return Ok(());
        }
        let mut modes = vec![0.0; self.modes.len()];
        from.fill("events.modes", &mut modes)?;
        self.modes = modes.into_iter().map(Mode::from_number).collect();
        [self.strongest] = from.finite("events.strongest")?;
        let mut gaps = vec![0.0; self.contacts.len()];
        from.fill("events.gaps", &mut gaps)?;
        self.contacts.iter_mut().zip(gaps).for_each(|(contact, gap)| contact.gap = gap);
        let mut memories = vec![[0.0; 10]; self.rigid.len()];
        from.fill("events.rigid", memories.as_flattened_mut())?;
        self.rigid.iter_mut().zip(memories).for_each(|(rigid, memory)| rigid.recall(memory));
        let mut memories = vec![[0.0; 19]; self.pressed.len()];
        from.fill("events.pressed", memories.as_flattened_mut())?;
        self.pressed = memories.into_iter().map(Pressed::of_memory).collect();
        Ok(())
    }

    /// Closes the bursts that go on at the end `time` of a run.
    pub(super) fn end(&mut self, time: f64) {
        for i in 0..self.contacts.len() {
            let (apart, by_step) = (self.apart, self.by_step);
            let last = self.rigid[i].closed.take();
            let last = last.and_then(|closed| self.rigid[i].add_closure(&closed, time, (apart, by_step)));
            let bursts = last.into_iter().chain(self.rigid[i].end());
            bursts.for_each(|burst| self.close(i, &burst));
        }
    }

    /// Adds the row of a burst of several impacts or closures that began in the run.
    fn close(&mut self, contact: usize, burst: &Burst) {
        let [since, time] = burst.range;
        if burst.parts > 1 && since.is_finite() {
            let entry = Entry {
                time,
                contact,
                what: "burst",
                impulse: Some(burst.impulse),
                duration: Some(time - since),
                ..Entry::default()
            };
            self.list.insert(self.list.partition_point(|other| other.time <= time), entry);
        }
    }

    /// Energy lost in impacts and in continuous forces \[J\], those that still press too.
    pub fn lost(&self) -> f64 {
        let listed: f64 = self.list.iter().filter_map(|entry| entry.lost).sum();
        listed + self.pressed.iter().map(|pressed| pressed.lost).sum::<f64>()
    }
}

impl Pressed {
    /// All of it, as numbers; NaN stands for what is not known.
    fn memory(&self) -> [f64; 19] {
        let mut out = [0.0; 19];
        out[..3].copy_from_slice(&[self.since.unwrap_or(f64::NAN), self.impulse, self.lost]);
        out[3..11].copy_from_slice(&self.force.memory());
        out[11..].copy_from_slice(&self.indentation.memory());
        out
    }

    fn of_memory(memory: [f64; 19]) -> Pressed {
        let [since, impulse, lost, largest @ ..] = memory;
        let since = Some(since).filter(|since| !since.is_nan());
        let [force, indentation] = [&largest[..8], &largest[8..]].map(Largest::of_memory);
        Pressed { since, impulse, lost, force, indentation }
    }

    fn enter(&mut self, t: f64, now: &ContactSample) {
        self.force.enter(t, now.force);
        self.indentation.enter(t, -now.gap);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn touch(name: &str, row: Option<usize>, indicator: Option<usize>) -> ContactInfo {
        let friction = row.map_or(0..0, |row| row + 1..row + 2);
        ContactInfo { name: name.into(), row, friction, indicator, gap: 1.0, ..ContactInfo::default() }
    }

    /// The entry in a line.
    fn text(events: &Events, e: &Entry) -> String {
        let quantities = [e.impulse, e.friction, e.speed, e.mass, e.lost, e.duration, e.force, e.indentation];
        let text = |x: Option<f64>| x.map(|x| format!("{x:?}")).unwrap_or_default();
        format!("{:?},{},{},{}", e.time, events.name(e.contact), e.what, quantities.map(text).join(","))
    }

    #[test]
    fn an_impact_is_one_row_for_each_contact_that_it_strikes_and_its_energy_counts_once() {
        let contacts = vec![touch("a", Some(0), None), touch("b", Some(2), None), touch("c", None, Some(0))];
        let mut events = Events { modes: vec![Mode::Open; 4], ..Events::of(contacts) };
        let kind = EventKind::Impact {
            impulses: vec![0.5, -0.1, 0.25, 0.0],
            lost: 2.0,
            rates: vec![-3.0, 1.0, -4.0, 0.0],
            masses: vec![0.2, 0.0, 0.1, 0.0],
        };
        let modes = vec![Mode::Open, Mode::Open, Mode::Closed, Mode::SlipForward];
        events.add(&Event { time: 0.5, kind, modes: modes.clone() });
        let crossing = || EventKind::Crossing { indicators: vec![0] };
        let at = |gap: f64, rate, force| ContactSample {
            place: Vec3([1.0, gap, 0.0]),
            gap,
            rate,
            force,
            lost: 0.0,
        };
        events.pressed = vec![Pressed::default(); 3];
        events.samples = vec![at(0.0, 0.0, 0.0), at(0.0, 0.0, 0.0), at(0.0, -2.0, 0.0)];
        events.add(&Event { time: 0.6, kind: crossing(), modes: modes.clone() });
        assert!(events.touching());
        // The parabola through 1, 4 and 3 has its vertex 4.125 between them.
        for (t, x) in [(0.25, 1.0), (0.5, 4.0), (0.75, 3.0)] {
            events.pressed[2].enter(t, &at(-x, 0.0, 2.0 * x));
        }
        (events.pressed[2].impulse, events.pressed[2].lost) = (0.5, 0.25);
        events.samples[2] = at(0.0, 1.5, 0.0);
        events.add(&Event { time: 0.7, kind: crossing(), modes });
        events.add(&Event { time: 0.8, kind: EventKind::Switch, modes: vec![Mode::Open; 4] });
        let rows: Vec<String> = events.list.iter().map(|e| text(&events, e)).collect();
        assert_eq!(
            rows,
            [
                "0.5,a,impact,0.5,-0.1,3.0,0.2,2.0,,,",
                "0.5,b,impact,0.25,0.0,4.0,0.1,,,,",
                "0.5,b,closed,,,,,,,,",
                "0.5,b,slips,,,,,,,,",
                "0.6,c,touched,,,2.0,,,,,",
                "0.7,c,left,0.5,,,,0.25,0.09999999999999998,8.25,4.125",
                "0.8,b,opened,0.0,,,,,0.30000000000000004,0.0,",
            ]
        );
        assert_eq!((events.impacts().count(), events.lost()), (3, 2.25));
        let places: Vec<_> = events.list.iter().map(|e| e.place).collect();
        assert_eq!((places[0], places[4]), (None, Some(Vec3([1.0, 0.0, 0.0]))));
    }
}
