//! `trajectory.csv`: one line for each recorded time, for people and spreadsheets.

use std::fmt::Write as _;
use std::io::{self, Read, Write};

use super::Trajectory;
use flexion::system::{Channel, Kind, Role};

/// Writes a trajectory as comma-separated values: a header `time [s],tip.deflection [m],…` (a pure
/// number has no brackets), then the rows. Every number is the shortest text that reads back as the
/// very same f64.
///
/// # Errors
/// Whatever `to` returns.
pub fn write_csv(trajectory: &Trajectory, to: impl Write) -> io::Result<()> {
    write(trajectory, to).map_err(io_error)
}

/// The system's own error where there is one: what to try depends on it.
pub(super) fn io_error(error: ::csv::Error) -> io::Error {
    match error.into_kind() {
        ::csv::ErrorKind::Io(error) => error,
        other => io::Error::other(format!("{other:?}")),
    }
}

fn write(trajectory: &Trajectory, to: impl Write) -> ::csv::Result<()> {
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
    Ok(csv.flush()?)
}

/// Reads what [`write_csv`] wrote, to the same bits; channels come back without their meaning. Lines that begin
/// with `#` are comments.
///
/// # Errors
/// What is wrong, with the line and the column: the first column must be the time, every other field a number.
pub fn read_csv(from: impl Read) -> Result<Trajectory, String> {
    let mut csv = ::csv::ReaderBuilder::new().comment(Some(b'#')).trim(::csv::Trim::All).from_reader(from);
    let header = csv.headers().map_err(|error| error.to_string())?.clone();
    let mut names = header.iter().map(split);
    match names.next() {
        Some(("time" | "t", "s" | "")) => {}
        _ => {
            let first = header.get(0).unwrap_or_default();
            return Err(format!("the first column is `{first}`, not `time [s]`: this is no trajectory"));
        }
    }
    let mut trajectory = Trajectory::new(names.map(|(name, unit)| channel(name, unit)).collect());
    for (index, channel) in trajectory.channels().iter().enumerate() {
        if channel.name == "time" || trajectory.index(&channel.name) != Some(index) {
            return Err(format!("two columns are called `{}`", channel.name));
        }
    }
    let mut record = ::csv::StringRecord::new();
    let mut row = Vec::new();
    while csv.read_record(&mut record).map_err(|error| error.to_string())? {
        row.clear();
        for (column, field) in record.iter().enumerate() {
            let number = field.parse::<f64>().map_err(|_| {
                let line = record.position().map_or(0, ::csv::Position::line);
                let column = header.get(column).unwrap_or_default();
                format!("`{field}` in line {line}, column `{column}`, is not a number")
            });
            row.push(number?);
        }
        if let [t, values @ ..] = row.as_slice() {
            trajectory.push(*t, |row| row.copy_from_slice(values));
        }
    }
    Ok(trajectory)
}

/// The channel of a column of a file of another program, in which columns have names and units only. The summary of a run says what
/// they are.
pub(super) fn channel(name: &str, unit: &str) -> Channel {
    let role = match name.split_once('.') {
        Some(("tip", "deflection" | "axial" | "chordwise" | "flapwise" | "torsion")) => Role::Primary,
        Some(("hub", "speed" | "torque")) => Role::Primary,
        Some(("tip" | "hub", _)) => Role::Secondary,
        Some(("energy", "balance")) => Role::Imbalance,
        Some(("energy", "total" | "drive" | "loads" | "dissipated" | "contact_loss")) => Role::Work,
        Some(("energy", _)) => Role::Energy,
        Some(("step" | "constraint", _)) => Role::Integration,
        Some((_, "gap" | "force" | "friction")) => Role::Secondary,
        _ => Role::Detail,
    };
    let component =
        [".rotation.w", ".rotation.x", ".rotation.y", ".rotation.z"].iter().any(|end| name.ends_with(end));
    let kind = if component && unit.is_empty() { Kind::Quaternion } else { Kind::Real };
    Channel::new(role, name, unit.to_owned(), "").with_kind(kind)
}

/// Name and unit of a column.
fn split(header: &str) -> (&str, &str) {
    match header.strip_suffix(']').and_then(|text| text.rsplit_once(" [")) {
        Some((name, unit)) => (name, unit),
        None => (header, ""),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::{channel, sample};

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

    #[test]
    fn a_trajectory_reads_back_as_it_was_written() {
        let mut t = Trajectory::new(vec![
            channel("x=2.5.deflection", "m"),
            channel("share", ""),
            channel("a,b", "rad/s^2"),
        ]);
        for (i, y) in [0.1 + 0.2, f64::NAN, -0.0, f64::NEG_INFINITY, 5e-324].into_iter().enumerate() {
            t.push(i as f64 / 3.0, |row| row.copy_from_slice(&[y, 1.0 / (1.0 + y), 1e300 * y]));
        }
        let read = read_csv(text(&t).as_bytes()).unwrap();
        let bits = |t: &Trajectory| {
            t.rows().flat_map(|(t, row)| [&[t], row].concat()).map(f64::to_bits).collect::<Vec<_>>()
        };
        assert_eq!(text(&read), text(&t));
        assert_eq!(bits(&read).len(), 20);
        for (a, b) in bits(&read).into_iter().zip(bits(&t)) {
            assert!(a == b || (f64::from_bits(a).is_nan() && f64::from_bits(b).is_nan()));
        }
        for (a, b) in read.channels().iter().zip(t.channels()) {
            assert_eq!((&a.name, &a.unit), (&b.name, &b.unit));
        }
    }

    #[test]
    fn a_file_that_is_no_trajectory_is_refused_with_its_fault() {
        for (text, fault) in [
            ("", "not `time [s]`"),
            ("a,b\n1,2\n", "`a`, not `time [s]`"),
            ("time [s],a [m],a [m]\n", "two columns are called `a`"),
            ("time [s],a [m]\n0,0\n1,x\n", "`x` in line 3, column `a [m]`"),
            ("time [s],a [m]\n0,0\n1\n", "line: 3"),
        ] {
            let error = read_csv(text.as_bytes()).unwrap_err();
            assert!(error.contains(fault), "{text:?}: {error}");
        }
    }

    #[test]
    fn a_full_disk_is_reported_as_such() {
        struct Full;
        impl Write for Full {
            fn write(&mut self, _: &[u8]) -> io::Result<usize> {
                Err(io::ErrorKind::StorageFull.into())
            }
            fn flush(&mut self) -> io::Result<()> {
                Ok(())
            }
        }
        let mut t = sample();
        for i in 5..5000 {
            t.push(f64::from(i), |_| {});
        }
        assert_eq!(write_csv(&t, Full).unwrap_err().kind(), io::ErrorKind::StorageFull);
        assert_eq!(write_csv(&sample(), Full).unwrap_err().kind(), io::ErrorKind::StorageFull);
    }
}
