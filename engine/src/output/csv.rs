//! `trajectory.csv`: one line for each recorded time, for people and spreadsheets.

use std::fmt::Write as _;
use std::io::{self, Write};

use super::Trajectory;

/// Writes a trajectory as comma-separated values: a header `time [s],tip.deflection [m],…` (a pure
/// number has no brackets), then the rows. Every number is the shortest text that reads back as the
/// very same f64.
///
/// # Errors
/// Whatever `to` returns.
pub fn write_csv(trajectory: &Trajectory, to: impl Write) -> io::Result<()> {
    let mut csv = ::csv::Writer::from_writer(to);
    csv.write_field("time [s]")?;
    for c in trajectory.channels() {
        let name = if c.unit.is_empty() { c.name.clone() } else { format!("{} [{}]", c.name, c.unit) };
        csv.write_field(name)?;
    }
    csv.write_record(None::<&[u8]>)?;
    let mut text = String::new();
    for (t, row) in trajectory.rows() {
        for y in std::iter::once(&t).chain(row) {
            text.clear();
            // `{:?}` is the shortest form that reads back exactly, with an exponent where that is short.
            let _ = write!(text, "{y:?}");
            csv.write_field(&text)?;
        }
        csv.write_record(None::<&[u8]>)?;
    }
    csv.flush()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::trajectory::tests::{channel, sample};

    fn text(t: &Trajectory) -> String {
        let mut out = Vec::new();
        write_csv(t, &mut out).unwrap();
        String::from_utf8(out).unwrap()
    }

    #[test]
    fn header_names_every_column_with_its_unit() {
        assert_eq!(text(&sample()).lines().next(), Some("time [s],tip.deflection [m],hub.speed [rad/s]"));
        let t = Trajectory::new(vec![channel("share", ""), channel("a,b", "m")]);
        assert_eq!(text(&t), "time [s],share,\"a,b [m]\"\n");
    }

    #[test]
    fn numbers_read_back_bit_for_bit() {
        let values = [0.1 + 0.2, 1.0 / 3.0, 5e-324, 1.797_693_134_862_315_7e308, -0.0, 123456789.0];
        let mut t = Trajectory::new(vec![channel("a", "m")]);
        for (i, y) in values.iter().enumerate() {
            t.push(i as f64 * 0.1, |row| row[0] = *y);
        }
        let text = text(&t);
        let read: Vec<f64> =
            text.lines().skip(1).map(|l| l.split(',').nth(1).unwrap().parse().unwrap()).collect();
        for (a, b) in read.iter().zip(values) {
            assert_eq!(a.to_bits(), b.to_bits());
        }
        assert!(text.len() < 200, "an extreme number is written with an exponent");
    }
}
