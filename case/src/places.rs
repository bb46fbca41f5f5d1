//! Places: the parts of a case and the points on them, by name.
//!
//! | written | place |
//! |---|---|
//! | `"ground"` | the ground |
//! | `"ball"` | the body of this name |
//! | `"arm"` | the whole of the beam of this name |
//! | `"arm@2 m"`, `"arm.root"`, `"arm.tip"` | a station of that beam, by its arc length from the root |
//! | `"2 m"`, `"root"`, `"tip"` | the same of the only beam |

use super::declaration::listed;
use super::fault::Fault;
use super::units;
use flexion_results::nearest;

/// A place that a case names.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place {
    /// The ground.
    Ground,
    /// A body, by its number.
    Body(usize),
    /// The whole of a beam, by its number.
    Beam(usize),
    /// A station of a beam.
    Station {
        /// Number of the beam.
        beam: usize,
        /// Arc length from the root \[m\].
        s: f64,
    },
}

/// The bodies and beams of a case.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Parts {
    /// Names of the bodies.
    pub bodies: Vec<String>,
    /// Names and lengths \[m\] of the beams.
    pub beams: Vec<(String, f64)>,
}

impl Parts {
    /// The place that is written so.
    ///
    /// # Errors
    /// A fault without key: no part of this name, a station without unit or beyond the tip, a beam that is not said.
    pub fn find(&self, written: &str) -> Result<Place, Fault> {
        let text = written.trim();
        if text == "ground" {
            return Ok(Place::Ground);
        }
        if let Some(i) = self.bodies.iter().position(|name| name == text) {
            return Ok(Place::Body(i));
        }
        let named = |name: &str| self.beams.iter().position(|(known, _)| known == name);
        if let Some(i) = named(text) {
            return Ok(Place::Beam(i));
        }
        if let Some((beam, station)) = text.split_once('@') {
            let beam = named(beam.trim()).ok_or_else(|| self.unknown(text))?;
            return self.station(written, beam, station.trim());
        }
        if let Some((beam, end)) = text.rsplit_once('.')
            && let (Some(beam), "root" | "tip") = (named(beam), end)
        {
            return self.station(written, beam, end);
        }
        let is_number = text.starts_with(|c: char| c.is_ascii_digit() || matches!(c, '.' | '+' | '-'));
        if !is_number && !matches!(text, "root" | "tip") {
            return Err(self.unknown(text));
        }
        match &self.beams[..] {
            [_] => self.station(written, 0, text),
            [] => Err(Fault::new("", format!("`{text}` is a station of a beam, and the case has none"))),
            [(first, _), ..] => {
                let like = if is_number { format!("{first}@{text}") } else { format!("{first}.{text}") };
                let message =
                    format!("`{text}` does not say of which beam, and there are {}", self.beams.len());
                Err(Fault::new("", message).help(format!("write for example `{like}`")))
            }
        }
    }

    /// The station of a beam: `root`, `tip`, or a length with its unit.
    fn station(&self, written: &str, beam: usize, text: &str) -> Result<Place, Fault> {
        let length = self.beams[beam].1;
        let s = match text {
            "root" => 0.0,
            "tip" => length,
            _ if text.parse::<f64>().is_ok() => {
                let message = format!("the station `{}` has no unit", written.trim());
                return Err(Fault::new("", message).help(format!("write `{} m`", written.trim())));
            }
            _ => units::parse(text, &units::STATION).map_err(|error| {
                Fault::new("", format!("`{written}`: {}", error.message)).help(error.help)
            })?,
        };
        if !(0.0..=length).contains(&s) {
            let message = format!("`{}` is not on the beam, which ends at {length} m", written.trim());
            return Err(Fault::new("", message));
        }
        Ok(Place::Station { beam, s })
    }

    /// That there is no such part.
    fn unknown(&self, text: &str) -> Fault {
        let ends = |name: &String| ["root", "tip"].map(|end| format!("{name}.{end}"));
        let mut all = vec!["ground".to_owned()];
        all.extend(self.bodies.iter().cloned());
        for (name, _) in &self.beams {
            all.push(name.clone());
            all.extend(ends(name));
        }
        if self.beams.len() == 1 {
            all.extend(["root", "tip"].map(str::to_owned));
        }
        let near = nearest(text, all.iter().map(String::as_str));
        let near = near.map_or(String::new(), |near| format!(": did you mean `{near}`?"));
        let mut listed = listed(all.iter().map(String::as_str));
        if let Some((beam, length)) = self.beams.first() {
            listed += &format!(", and stations such as `{beam}@{} m`", 0.5 * length);
        }
        Fault::new("", format!("there is no part `{text}`{near}")).help(format!("the parts are {listed}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parts(beams: &[(&str, f64)]) -> Parts {
        let beams = beams.iter().map(|(name, length)| ((*name).to_owned(), *length)).collect();
        Parts { bodies: vec!["ball".to_owned()], beams }
    }

    #[test]
    fn every_spelling_of_a_place_is_the_same_place() {
        let one = parts(&[("arm", 2.5)]);
        let at = |s| Ok(Place::Station { beam: 0, s });
        for (text, place) in [
            ("ground", Ok(Place::Ground)),
            ("ball", Ok(Place::Body(0))),
            ("arm", Ok(Place::Beam(0))),
            ("tip", at(2.5)),
            ("arm.tip", at(2.5)),
            ("arm@2.5 m", at(2.5)),
            ("250 cm", at(2.5)),
            ("root", at(0.0)),
            ("arm.root", at(0.0)),
            ("arm@ 0.5 m", at(0.5)),
            (".5 m", at(0.5)),
        ] {
            assert_eq!(one.find(text), place, "{text}");
        }
        let two = parts(&[("arm", 2.5), ("fore", 1.0)]);
        assert_eq!(two.find("fore@40 cm"), Ok(Place::Station { beam: 1, s: 0.4 }));
    }

    #[test]
    fn a_place_that_is_none_is_refused_with_what_to_write() {
        let (one, two) = (parts(&[("arm", 2.5)]), parts(&[("arm", 2.5), ("fore", 1.0)]));
        for (parts, text, message, help) in [
            (&one, "arm@2", "has no unit", "`arm@2 m`"),
            (&one, "2", "has no unit", "`2 m`"),
            (&one, "arm@2.6 m", "ends at 2.5 m", ""),
            (&one, "-1 m", "ends at 2.5 m", ""),
            (&one, "arm@2 kg", "kg", "m"),
            (&one, "amr.tip", "did you mean `arm.tip`?", "`arm@1.25 m`"),
            (&one, "arm.middle", "no part", "`arm.root`"),
            (&two, "tip", "of which beam", "`arm.tip`"),
            (&two, "1 m", "of which beam", "`arm@1 m`"),
            (&parts(&[]), "tip", "the case has none", ""),
        ] {
            let fault = parts.find(text).unwrap_err();
            assert!(fault.message.contains(message), "{text}: {}", fault.message);
            assert!(fault.help.unwrap_or_default().contains(help), "{text}");
        }
    }
}
