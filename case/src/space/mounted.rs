//! How a blade is mounted on what rotates: with its leading edge ahead.

use super::Space;
use crate::kinds::beam::Beam;
use crate::kinds::rotation::Rotation;
use flexion::multibody::Axis;

/// Where along a blade its motion is taken.
const OUTER: f64 = 0.75;
/// Distance from the axis, over the length, within which all of a blade lies that rotates about itself.
const OWN: f64 = 0.1;
/// Part of its direction that a chord has along the motion at least.
const ALONG: f64 = 0.5;

impl Space {
    /// Cautions for the blades of decks, as they are mounted on what rotates in a run of this duration \[s\].
    pub(super) fn mounted(&self, duration: f64) -> Vec<String> {
        let Ok(Rotation { axis, keeps }) = &self.rotation else { return Vec::new() };
        let model = self.multibody.model();
        let prescribed = keeps.as_ref().map_or(0.0, |joint| model.prescribed_speed(joint, axis, duration));
        let speed = match prescribed {
            0.0 => self.rotates_at().ok().flatten().unwrap_or(0.0),
            prescribed => prescribed,
        };
        self.beams.iter().filter_map(|(beam, _)| caution(beam, axis, Sense::of(speed))).collect()
    }
}

/// How a case rotates about its axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Sense {
    /// With a positive speed, or with none that the case gives.
    Forwards,
    /// With a negative speed.
    Backwards,
}

impl Sense {
    /// Of a speed.
    fn of(speed: f64) -> Sense {
        if speed < 0.0 { Sense::Backwards } else { Sense::Forwards }
    }
}

/// What is unlikely of the place of a deck's blade beside an axis about which it rotates with a positive speed, or with one that `turns` backwards.
fn caution(beam: &Beam, axis: &Axis, turns: Sense) -> Option<String> {
    beam.section.deck.as_ref()?;
    let (name, e) = (&beam.name, axis.direction);
    let (sign, sense) = match turns {
        Sense::Forwards => (1.0, "positive"),
        Sense::Backwards => (-1.0, "negative"),
    };
    let distance = |s: f64| (beam.frame(s).position - axis.point).across(e).norm();
    let farthest = distance(0.0).max(distance(beam.length));
    if farthest <= OWN * beam.length {
        return Some(format!(
            "the blade `{name}` rotates about its own axis: none of its ends is farther than {farthest:.4} m from the axis of rotation; is its `direction`, or the \
             axis, another?"
        ));
    }
    let outer = beam.frame(OUTER * beam.length);
    let motion = sign * e.cross(outer.position - axis.point);
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
            libm::acos(ahead.clamp(-1.0, 1.0)).to_degrees()
        )
    };
    Some(format!(
        "the blade `{name}` {what}, where it rotates with a {sense} speed about ({}): is its `up` or `pitch`, or the sense of the axis, another?",
        e.0.map(|x| format!("{:.4}", x + 0.0)).join(", ")
    ))
}
