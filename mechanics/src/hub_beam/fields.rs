//! The two displacement fields of a planar beam: their bases, the numbering of the unknowns along the
//! beam, and the quadrature over both.

use crate::basis::{Basis, BasisError, MasslessTip, Role};
use crate::linalg::{Matrix, Structure};
use crate::quadrature::Gauss;
use std::sync::Arc;

/// Gauss points of a cell in addition to those of its bases, for a section that varies inside it.
const EXTRA_POINTS: usize = 2;

/// Axial field w₁ = Σ φx_i A_i and transverse field w₂ = Σ φy_i B_i over x ∈ [0, L].
///
/// The unknowns of both are numbered together in the order of their anchors along the beam, which
/// keeps the matrices narrow bands for any two bases.
#[derive(Debug)]
pub struct Fields {
    length: f64,
    axial: Arc<dyn Basis>,
    transverse: Arc<dyn Basis>,
    /// The fields that the mass of the beam follows, if the tip has none.
    inertial: Option<Box<Fields>>,
    /// Number of the unknown of each axial function, then of each transverse one.
    axial_index: Vec<usize>,
    transverse_index: Vec<usize>,
    /// Union of the cells of both bases and of the breaks of the section.
    cells: Vec<f64>,
    gauss: Gauss,
    half_bandwidth: usize,
}

/// The functions of one field that do not vanish at a point, with their unknowns.
#[derive(Clone, Debug, Default)]
pub struct Shapes {
    /// Number of the unknown of each function.
    pub index: Vec<usize>,
    /// φ, φ′, φ″ of each function at the point.
    pub value: [Vec<f64>; 3],
}

impl Shapes {
    /// Derivative `d` of the field with coefficients `q` at the point.
    #[inline]
    pub fn field(&self, d: usize, q: &[f64]) -> f64 {
        self.index.iter().zip(&self.value[d]).map(|(&i, phi)| phi * q[i]).sum()
    }

    /// out += c φ
    #[inline]
    pub fn add(&self, c: f64, out: &mut [f64]) {
        for (&i, phi) in self.index.iter().zip(&self.value[0]) {
            out[i] += c * phi;
        }
    }
}

/// Both fields at one quadrature point or station.
#[derive(Clone, Debug, Default)]
pub struct Point {
    /// Station x \[m\].
    pub x: f64,
    /// Quadrature weight \[m\].
    pub weight: f64,
    /// Functions of the axial field.
    pub axial: Shapes,
    /// Functions of the transverse field.
    pub transverse: Shapes,
}

impl Fields {
    /// The fields on [0, `length`]; `breaks` are the stations at which the section jumps.
    pub fn new(length: f64, axial: Box<dyn Basis>, transverse: Box<dyn Basis>, breaks: &[f64]) -> Fields {
        let mut cells: Vec<f64> = [axial.cells(), transverse.cells(), breaks].concat();
        cells.retain(|x| (0.0..=length).contains(x));
        cells.sort_by(f64::total_cmp);
        cells.dedup_by(|b, a| *b - *a <= 1e-12 * length);
        let (na, nt) = (axial.len(), transverse.len());
        // (anchor, field, function): a stable order along the beam.
        let mut order: Vec<(f64, usize, usize)> = (0..na).map(|i| (axial.anchor(i), 0, i)).collect();
        order.extend((0..nt).map(|i| (transverse.anchor(i), 1, i)));
        order.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2)));
        let (mut axial_index, mut transverse_index) = (vec![0; na], vec![0; nt]);
        for (number, &(_, field, i)) in order.iter().enumerate() {
            let index = if field == 0 { &mut axial_index } else { &mut transverse_index };
            index[i] = number;
        }
        let points = axial.points_per_cell().max(transverse.points_per_cell()) + EXTRA_POINTS;
        let mut fields = Fields {
            length,
            axial: Arc::from(axial),
            transverse: Arc::from(transverse),
            inertial: None,
            axial_index,
            transverse_index,
            cells,
            gauss: Gauss::new(points),
            half_bandwidth: 0,
        };
        fields.half_bandwidth = fields.measure_bandwidth();
        fields
    }

    /// The same fields for a beam whose tip has no mass: see [`MasslessTip`].
    ///
    /// # Errors
    /// [`BasisError`] if the transverse basis has no function that moves the tip alone.
    pub fn with_massless_tip(self) -> Result<Fields, BasisError> {
        let Some(transverse) = MasslessTip::new(Arc::clone(&self.transverse)) else {
            return Err(BasisError::Invalid(
                "no function of this basis moves the tip alone, and its mass cannot be taken away: use finite elements or \
                 modes"
                    .to_owned(),
            ));
        };
        let axial: Arc<dyn Basis> = match MasslessTip::new(Arc::clone(&self.axial)) {
            Some(axial) => Arc::new(axial),
            None => Arc::clone(&self.axial),
        };
        let inertial = Fields {
            axial,
            transverse: Arc::new(transverse),
            inertial: None,
            axial_index: self.axial_index.clone(),
            transverse_index: self.transverse_index.clone(),
            cells: self.cells.clone(),
            gauss: self.gauss.clone(),
            ..self
        };
        Ok(Fields { inertial: Some(Box::new(inertial)), ..self })
    }

    /// The fields that the mass of the beam follows.
    pub fn inertial(&self) -> &Fields {
        self.inertial.as_deref().unwrap_or(self)
    }

    fn measure_bandwidth(&self) -> usize {
        let mut widest = 0;
        for ends in self.cells.windows(2) {
            let middle = 0.5 * (ends[0] + ends[1]);
            let axial = self.axial.support(self.axial.locate(middle));
            let transverse = self.transverse.support(self.transverse.locate(middle));
            let numbers = self.axial_index[axial].iter().chain(&self.transverse_index[transverse]).copied();
            if let (Some(first), Some(last)) = (numbers.clone().min(), numbers.max()) {
                widest = widest.max(last - first);
            }
        }
        widest
    }

    /// Length L of the beam \[m\].
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Number of unknowns of both fields.
    pub fn len(&self) -> usize {
        self.axial.len() + self.transverse.len()
    }

    /// Whether there is no unknown.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The axial basis.
    pub fn axial(&self) -> &dyn Basis {
        &*self.axial
    }

    /// The transverse basis.
    pub fn transverse(&self) -> &dyn Basis {
        &*self.transverse
    }

    /// Boundaries of the integration cells.
    pub fn cells(&self) -> &[f64] {
        &self.cells
    }

    /// The quadrature rule of a cell.
    pub fn gauss(&self) -> &Gauss {
        &self.gauss
    }

    /// Structure of the matrices of the fields, with `border` further unknowns behind.
    pub fn structure(&self, border: usize) -> Structure {
        Structure::band(self.len(), self.half_bandwidth, self.half_bandwidth, border).cheaper()
    }

    /// Numbers of the unknowns of the axial and of the transverse functions.
    pub fn indices(&self) -> (&[usize], &[usize]) {
        (&self.axial_index, &self.transverse_index)
    }

    /// Size by which each unknown is measured: the length \[m\], for slopes 1.
    pub fn scales(&self) -> Vec<f64> {
        let mut scales = vec![self.length; self.len()];
        for (basis, index) in [(&self.axial, &self.axial_index), (&self.transverse, &self.transverse_index)] {
            let slopes = index.iter().enumerate().filter(|(i, _)| basis.role(*i) == Role::Slope);
            slopes.for_each(|(_, &number)| scales[number] = 1.0);
        }
        scales
    }

    /// Name of unknown `number` for messages, if there is one.
    pub fn name(&self, number: usize) -> Option<String> {
        let find = |index: &[usize]| index.iter().position(|i| *i == number);
        let axial = find(&self.axial_index).map(|i| (&self.axial, "axial", i));
        let transverse = || find(&self.transverse_index).map(|i| (&self.transverse, "transverse", i));
        let (basis, field, i) = axial.or_else(transverse)?;
        let at = basis.anchor(i);
        Some(match basis.role(i) {
            Role::Value => format!("{field} displacement at x = {at:.4} m"),
            Role::Slope => format!("slope of the {field} displacement at x = {at:.4} m"),
            Role::Control => format!("{field} displacement of the control point at x = {at:.4} m"),
            Role::Amplitude => format!("amplitude of {field} shape {}", i + 1),
        })
    }

    /// Both fields at `x`, with a quadrature weight.
    pub fn point(&self, x: f64, weight: f64) -> Point {
        let mut point = Point { x, weight, ..Point::default() };
        self.fill(x, self.locate(x), &mut point);
        point
    }

    /// Both fields at the end of cell `cell`, by the functions of that cell.
    pub fn cell_end(&self, cell: usize) -> Point {
        let (start, end) = (self.cells[cell], self.cells[cell + 1]);
        let mut point = Point { x: end, ..Point::default() };
        self.fill(end, self.locate(0.5 * (start + end)), &mut point);
        point
    }

    /// The cells of both bases in which `x` lies.
    fn locate(&self, x: f64) -> [usize; 2] {
        [self.axial.locate(x), self.transverse.locate(x)]
    }

    /// Fills the shapes of `point` at `x`, by the functions of these cells of both bases.
    fn fill(&self, x: f64, [axial, transverse]: [usize; 2], point: &mut Point) {
        for (basis, numbers, shapes, cell) in [
            (&self.axial, &self.axial_index, &mut point.axial, axial),
            (&self.transverse, &self.transverse_index, &mut point.transverse, transverse),
        ] {
            let support = basis.support(cell);
            shapes.index.clear();
            shapes.index.extend_from_slice(&numbers[support.clone()]);
            for d in 0..3 {
                shapes.value[d].resize(support.len(), 0.0);
                basis.eval(cell, x, d, &mut shapes.value[d]);
            }
        }
    }

    /// Calls `f` at every quadrature point, cell after cell.
    pub fn integrate(&self, f: impl FnMut(&Point)) {
        self.integrate_over(&self.cells, f);
    }

    /// As [`Fields::integrate`], over `cells` that are parts of those of the fields.
    pub fn integrate_over(&self, cells: &[f64], mut f: impl FnMut(&Point)) {
        let mut point = Point::default();
        for ends in cells.windows(2) {
            let within = self.locate(0.5 * (ends[0] + ends[1]));
            for (x, weight) in self.gauss.on(ends[0], ends[1]) {
                (point.x, point.weight) = (x, weight);
                self.fill(x, within, &mut point);
                f(&point);
            }
        }
    }

    /// The tail integral ∫ₓᴸ f dξ as a function of x: O(log n) a call after O(n) preparation.
    pub fn tail<'a, F: Fn(f64) -> f64 + 'a>(&'a self, f: F) -> impl Fn(f64) -> f64 + 'a {
        self.tail_over(&self.cells, f)
    }

    /// As [`Fields::tail`], over `cells` that are parts of those of the fields.
    pub fn tail_over<'a, F: Fn(f64) -> f64 + 'a>(
        &'a self,
        cells: &'a [f64],
        f: F,
    ) -> impl Fn(f64) -> f64 + 'a {
        let mut beyond = vec![0.0; cells.len()];
        for c in (0..cells.len() - 1).rev() {
            beyond[c] = beyond[c + 1] + self.gauss.integrate(cells[c], cells[c + 1], &f);
        }
        move |x| {
            let cell = cells[1..cells.len() - 1].partition_point(|&end| end <= x);
            beyond[cell + 1] + self.gauss.integrate(x, cells[cell + 1], &f)
        }
    }
}

/// out += w φ⁽ᵈ⁾
pub fn add_vector(out: &mut [f64], shapes: &Shapes, d: usize, w: f64) {
    for (&i, phi) in shapes.index.iter().zip(&shapes.value[d]) {
        out[i] += w * phi;
    }
}

/// out += w φ⁽ᵈ⁾ ψ⁽ᵉ⁾ᵀ
pub fn add_outer(out: &mut Matrix, row: (&Shapes, usize), column: (&Shapes, usize), w: f64) {
    if w == 0.0 {
        return;
    }
    for (&i, phi) in row.0.index.iter().zip(&row.0.value[row.1]) {
        for (&j, psi) in column.0.index.iter().zip(&column.0.value[column.1]) {
            out.add(i, j, w * phi * psi);
        }
    }
}
