//! How a blade is mounted on what rotates: with its leading edge ahead.

use crate::kinds::beam::Beam;
use flexion::multibody::Axis;

/// Where along a blade its motion is taken.
const OUTER: f64 = 0.75;
/// Distance from the axis, over the length, within which all of a blade lies that rotates about itself.
const OWN: f64 = 0.1;
/// Part of its direction that a chord has along the motion at least.
const ALONG: f64 = 0.5;

/// What is unlikely of the place of a deck's blade beside an axis about which it rotates with a positive speed.
pub(super) fn caution(beam: &Beam, axis: &Axis) -> Option<String> {
    beam.section.deck.as_ref()?;
    let (name, e) = (&beam.name, axis.direction);
    let distance = |s: f64| (beam.frame(s).position - axis.point).across(e).norm();
    let farthest = distance(0.0).max(distance(beam.length));
    if farthest <= OWN * beam.length {
        return Some(format!(
            "the blade `{name}` rotates about its own axis: none of its ends is farther than {farthest:.4} m from the axis of rotation; is its `direction`, or the \
             axis, another?"
        ));
    }
    let outer = beam.frame(OUTER * beam.length);
    let motion = e.cross(outer.position - axis.point);
    // The height points to the trailing edge.
    let ahead = -outer.rotation.column(1).dot(motion) / motion.norm();
    if ahead >= ALONG {
        return None;
    }
    let what = if ahead <= -ALONG {
        "goes ahead with its trailing edge, to which the y of a deck points".to_owned()
    } else {
        format!(
            "has its chord across its motion, by {:.0}° at {OUTER} of its length",
            ahead.clamp(-1.0, 1.0).acos().to_degrees()
        )
    };
    Some(format!(
        "the blade `{name}` {what}, where it rotates with a positive speed about ({}): is its `up` or `pitch`, or the sense of the axis, another?",
        e.0.map(|x| format!("{:.4}", x + 0.0)).join(", ")
    ))
}
