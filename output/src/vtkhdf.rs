//! `beam.vtkhdf`: the moving beam for ParaView (5.12 or later) in one file.
//!
//! The strip of [`super::write_vtu`], with the same points, cells and arrays, at all times: an unstructured grid
//! of VTKHDF 2.0 whose cells and arc lengths are stored once, and whose points and other arrays follow one
//! another from time to time. The file is plain HDF5, open to h5py and MATLAB: `/VTKHDF/Steps/Values` holds the
//! times [s]; `/VTKHDF/Steps/PointOffsets` holds the first row of each time in `/VTKHDF/Points` and
//! `/VTKHDF/PointData`.
//!
//! Format: <https://docs.vtk.org/en/latest/vtk_file_formats/vtkhdf_file_format/vtkhdf_specifications.html>.

use std::io::{self, Write};

use hdf5_writer::{
    AttributeBuilder, DatasetBuilder, Datatype, Error, H5WriteElement, Hdf5Builder, StringEncoding,
    StringPadding, StringSize, WriteOptions,
};

use super::shapes::Shapes;
use super::vtk::{QUAD, fibres, quads, relative};

/// Writes the shapes of all times as a VTKHDF unstructured grid (`.vtkhdf`).
///
/// The file is put together in memory, in about three times the space of its numbers: nine doubles for each
/// point and time. The same shapes give the same bytes.
///
/// # Errors
/// Whatever `to` returns.
pub fn write_vtkhdf(shapes: &Shapes, mut to: impl Write) -> io::Result<()> {
    to.write_all(&encode(shapes).map_err(io::Error::other)?)
}

/// Point arrays that change with time, one after another for all times.
#[derive(Default)]
struct Arrays {
    points: Vec<f64>,
    displacement: Vec<f64>,
    deflection: Vec<f64>,
    axial: Vec<f64>,
    rotation: Vec<f64>,
}

impl Arrays {
    fn of(shapes: &Shapes) -> Arrays {
        let mut arrays = Arrays::default();
        for shape in shapes.iter() {
            arrays.points.extend(shape.frames.iter().flat_map(|f| fibres(f, shape.height)).flatten());
            for moved in relative(&shape) {
                // Lower fibre, axis and upper fibre alike.
                arrays.displacement.extend([moved.displacement; 3].as_flattened());
                arrays.deflection.extend([moved.deflection; 3]);
                arrays.axial.extend([moved.axial; 3]);
                arrays.rotation.extend([moved.rotation; 3]);
            }
        }
        arrays
    }
}

fn encode(shapes: &Shapes) -> Result<Vec<u8>, Error> {
    let times = shapes.times();
    let steps = times.len();
    let stations = shapes.iter().next().map_or(&[][..], |shape| shape.stations);
    let points = 3 * stations.len();
    let (connectivity, ends) = quads(stations.len());
    let arc_length: Vec<f64> = stations.iter().flat_map(|x| [*x; 3]).collect();
    let offsets: Vec<i64> = std::iter::once(0).chain(ends.iter().map(|end| i64::from(*end))).collect();
    let connectivity: Vec<i64> = connectivity.into_iter().map(i64::from).collect();
    let arrays = Arrays::of(shapes);
    let moving: Vec<i64> = (0..steps).map(|step| (step * points) as i64).collect();
    let fixed = vec![0_i64; steps];

    let mut file = Hdf5Builder::new()
        .group_attribute("VTKHDF", AttributeBuilder::vector("Version", &[2_i64, 0])?)
        .group_attribute("VTKHDF", text("Type", "UnstructuredGrid"))
        .group_attribute("VTKHDF/Steps", AttributeBuilder::scalar("NSteps", steps as i64)?);
    let mut add = |dataset: DatasetBuilder| file = std::mem::take(&mut file).dataset(dataset);

    // One part, whose sizes hold at every time. Arrays are given away, to be held once.
    add(list("NumberOfPoints", [points as i64])?);
    add(list("NumberOfCells", [ends.len() as i64])?);
    add(list("NumberOfConnectivityIds", [connectivity.len() as i64])?);
    add(table("Points", 3, arrays.points)?);
    add(list("Connectivity", connectivity)?);
    add(list("Offsets", offsets)?);
    add(list("Types", vec![QUAD; ends.len()])?);
    add(table("PointData/displacement", 3, arrays.displacement)?);
    add(list("PointData/deflection", arrays.deflection)?);
    add(list("PointData/axial", arrays.axial)?);
    add(list("PointData/rotation", arrays.rotation)?);
    add(list("PointData/arc_length", arc_length)?);

    add(list("Steps/Values", times)?);
    add(list("Steps/PartOffsets", &fixed)?);
    add(list("Steps/NumberOfParts", vec![1_i64; steps])?);
    add(list("Steps/PointOffsets", &moving)?);
    add(table("Steps/CellOffsets", 1, &fixed)?);
    add(table("Steps/ConnectivityIdOffsets", 1, &fixed)?);
    for name in ["displacement", "deflection", "axial", "rotation"] {
        add(list(&format!("Steps/PointDataOffsets/{name}"), &moving)?);
    }
    add(list("Steps/PointDataOffsets/arc_length", &fixed)?);
    file.into_plan()?.encode(WriteOptions::default())
}

/// A text of fixed length in ASCII, as in the examples of the format.
fn text(name: &str, value: &str) -> AttributeBuilder {
    let kind = Datatype::String {
        size: StringSize::Fixed(value.len() as u32),
        encoding: StringEncoding::Ascii,
        padding: StringPadding::NullPad,
    };
    AttributeBuilder::new(name, kind, Vec::new(), value.as_bytes())
}

/// A dataset of one dimension in the group of VTK.
fn list<T: H5WriteElement>(name: &str, values: impl AsRef<[T]>) -> Result<DatasetBuilder, Error> {
    let values = values.as_ref();
    dataset(name, vec![values.len() as u64], values)
}

/// A dataset of rows of `width` values in the group of VTK.
fn table<T: H5WriteElement>(
    name: &str,
    width: usize,
    values: impl AsRef<[T]>,
) -> Result<DatasetBuilder, Error> {
    let values = values.as_ref();
    dataset(name, vec![(values.len() / width) as u64, width as u64], values)
}

fn dataset<T: H5WriteElement>(name: &str, shape: Vec<u64>, values: &[T]) -> Result<DatasetBuilder, Error> {
    DatasetBuilder::typed_data(format!("VTKHDF/{name}"), shape, values)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::ErrorKind;

    #[test]
    fn no_shapes_are_a_file_without_times() {
        let shapes = Shapes::new(1.0, &[0.3], 0.1, 1);
        let bytes = encode(&shapes).unwrap();
        assert!(bytes.starts_with(b"\x89HDF\r\n\x1a\n"));
        assert!(bytes == encode(&shapes).unwrap());
    }

    #[test]
    fn a_full_disk_is_reported_as_such() {
        let shapes = Shapes::new(1.0, &[], 0.1, 1);
        let mut small = [0; 100];
        assert_eq!(write_vtkhdf(&shapes, &mut small[..]).unwrap_err().kind(), ErrorKind::WriteZero);
    }
}
