//! `events.csv`: impacts of a run, contacts that close, open, slip or stick, forces that touch and leave, and bursts of impacts.

use super::csv::io_error;
use super::{Entry, Events};
use flexion::contact::Neglected;
use serde_json::{Value, json};
use std::io::{self, Write};

/// Rows of the list that a summary shows at either end.
const SHOWN: usize = 5;

/// Number of impacts, energy lost in them, and the first and last events, for a summary.
pub(super) fn to_json(events: &Events) -> Value {
    let entry = |e: &Entry| {
        json!({
            "time": e.time, "contact": events.name(e.contact), "event": e.what, "impulse": e.impulse,
            "friction": e.friction, "closing_speed": e.speed, "effective_mass": e.mass, "energy_lost": e.lost,
            "duration": e.duration, "largest_force": e.force, "largest_indentation": e.indentation, "place": e.place.map(|x| x.0),
        })
    };
    let impulses: serde_json::Map<String, Value> =
        events.impulses().map(|(name, impulse)| (name.to_owned(), json!(impulse))).collect();
    let (n, list) = (events.list.len(), &events.list);
    let Neglected { count, time, gap, energy } = events.neglected;
    json!({
        "count": n,
        "impacts": events.impacts().count(),
        "energy_lost_in_impacts": events.lost(),
        "impulse_of_rigid_contacts": impulses,
        "first": list[..n.min(SHOWN)].iter().map(entry).collect::<Vec<_>>(),
        "last": list[n.saturating_sub(SHOWN).max(n.min(SHOWN))..].iter().map(entry).collect::<Vec<_>>(),
        "bounces_not_followed": { "contacts": count, "time": time, "gap": gap, "energy": energy },
    })
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
    use flexion::system::ContactInfo;

    #[test]
    fn a_row_is_empty_where_a_quantity_does_not_apply_and_a_summary_shows_both_ends_of_the_list() {
        let mut events = Events::of(
            ["a", "b"].map(|name| ContactInfo { name: name.into(), ..ContactInfo::default() }).into(),
        );
        let impact = Entry {
            time: 0.5,
            what: "impact",
            impulse: Some(0.25),
            friction: Some(-0.1),
            speed: Some(4.0),
            mass: Some(0.1),
            lost: Some(2.0),
            ..Entry::default()
        };
        let left = Entry {
            time: 0.7,
            contact: 1,
            what: "left",
            duration: Some(0.125),
            force: Some(8.25),
            indentation: Some(4.125),
            place: Some(flexion::linalg::Vec3([1.0, 0.0, -2.0])),
            ..Entry::default()
        };
        events.list = vec![impact, left];
        let mut out = Vec::new();
        write_events(&events, &mut out).unwrap();
        let text = String::from_utf8(out).unwrap();
        assert_eq!(
            text.lines().skip(1).collect::<Vec<_>>(),
            ["0.5,a,impact,0.25,-0.1,4.0,0.1,2.0,,,,,,", "0.7,b,left,,,,,,0.125,8.25,4.125,1.0,0.0,-2.0"]
        );
        events.list = vec![events.list[0].clone(); 7];
        let json = to_json(&events);
        assert_eq!((json["first"].as_array().unwrap().len(), json["last"].as_array().unwrap().len()), (5, 2));
    }
}
