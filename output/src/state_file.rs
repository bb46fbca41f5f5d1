//! `state.npz`: the last accepted step of a run, from which it can go on.

#[cfg(feature = "archives")]
use std::io::{self, Write};
use std::io::{Read, Seek};

#[cfg(feature = "archives")]
use super::{archive, npz::write_array};
use flexion::integrator::Checkpoint;

#[cfg(feature = "archives")]
/// Name of the text that says which model the state belongs to, and which integrator.
const MODEL: &str = "model";

/// Writes a checkpoint as a NumPy archive: one array of f64 for each list, and one of bytes, `model`, with the `text`
/// that says what it belongs to. The same checkpoint gives the same bytes.
///
/// # Errors
/// Whatever `to` returns.
#[cfg(feature = "archives")]
pub fn write_state(checkpoint: &Checkpoint, text: &str, to: impl Write + Seek) -> io::Result<()> {
    let mut archive = archive::archive(to);
    for (name, values) in checkpoint.entries() {
        write_array(&mut archive, name, values.len(), values.iter().copied())?;
    }
    write_array(&mut archive, MODEL, text.len(), text.bytes())?;
    archive::finish(archive)
}

/// Reads what [`write_state`] wrote: the checkpoint and the text.
///
/// # Errors
/// What is wrong with the file, for people.
#[cfg(feature = "archives")]
pub fn read_state(from: impl Read + Seek) -> Result<(Checkpoint, String), String> {
    let (mut checkpoint, mut text) = (Checkpoint::default(), None);
    archive::arrays(from, |name, array| {
        if name == MODEL {
            let bytes = array.into_vec::<u8>()?;
            text = Some(String::from_utf8(bytes).map_err(io::Error::other)?);
        } else {
            checkpoint.put(name, &array.into_vec::<f64>()?);
        }
        Ok(())
    })?;
    let text = text.ok_or("it does not say which model it belongs to")?;
    Ok((checkpoint, text))
}

/// Reads nothing: this build has no archives.
///
/// # Errors
/// Always.
#[cfg(not(feature = "archives"))]
pub fn read_state(_: impl Read + Seek) -> Result<(Checkpoint, String), String> {
    Err("this build of Flexion reads no archives of NumPy".to_owned())
}

#[cfg(feature = "archives")]
#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Cursor;

    fn sample() -> Vec<u8> {
        let mut checkpoint = Checkpoint::default();
        checkpoint.put("q", &[1.0, f64::NAN, -0.0, 5e-324]);
        checkpoint.put("lambda", &[]);
        let mut out = Cursor::new(Vec::new());
        write_state(&checkpoint, "beam.length = 1.0\n", &mut out).unwrap();
        out.into_inner()
    }

    #[test]
    fn a_state_reads_back_bit_by_bit() {
        let (checkpoint, text) = read_state(Cursor::new(sample())).unwrap();
        let bits = |x: &[f64]| x.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(checkpoint.list("q").unwrap()), bits(&[1.0, f64::NAN, -0.0, 5e-324]));
        assert_eq!(checkpoint.list("lambda").unwrap(), [0.0; 0]);
        assert_eq!(text, "beam.length = 1.0\n");
        assert!(sample() == sample());
    }

    #[test]
    fn what_is_no_state_is_refused_with_the_reason() {
        let whole = sample();
        for cut in [0, 10, whole.len() / 2, whole.len() - 1] {
            assert!(read_state(Cursor::new(&whole[..cut])).is_err(), "{cut}");
        }
        for i in 0..8 * whole.len() {
            let mut changed = whole.clone();
            changed[i / 8] ^= 1 << (i % 8);
            // An error, or the very state where the byte says nothing about it (as dates and permissions).
            if let Ok((checkpoint, text)) = read_state(Cursor::new(changed)) {
                let (before, text_before) = read_state(Cursor::new(&whole)).unwrap();
                let bits = |c: &Checkpoint| -> Vec<(String, Vec<u64>)> {
                    let bits = |x: &[f64]| x.iter().map(|x| x.to_bits()).collect();
                    c.entries().map(|(name, list)| (name.to_owned(), bits(list))).collect()
                };
                assert_eq!((bits(&checkpoint), text), (bits(&before), text_before), "bit {i}");
            }
        }
        let mut other = Cursor::new(Vec::new());
        super::super::write_npz(&crate::samples::sample(), &mut other).unwrap();
        let reason = read_state(Cursor::new(other.into_inner())).unwrap_err();
        assert!(reason.contains("which model"), "{reason}");
    }
}
