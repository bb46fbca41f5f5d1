//! The cross-section of a beam, of whatever kind.

use crate::files::deck::Deck;
use flexion::section::{self, BladeResultants, BladeSection, PlanarBlade, SectionError, Shape};
use std::fmt;
use std::sync::Arc;

/// What a beam assumes of the material of its section.
#[derive(Clone, Copy, Debug)]
pub struct Assumed {
    /// Poisson's ratio.
    pub poisson_ratio: f64,
    /// The shear factor of a shape; its own if left out.
    pub shear_factor: Option<f64>,
}

/// Makes the section of a blade.
pub(super) type Spatial = Arc<dyn Fn(Assumed) -> Result<Box<dyn BladeSection>, SectionError> + Send + Sync>;

/// The cross-section of a beam.
#[derive(Clone)]
pub struct Section {
    /// For bending in the plane of motion.
    pub planar: Arc<dyn section::Section>,
    /// Height in the plane of motion \[m\], at the root if it tapers; `None` when only resultants are known.
    pub height: Option<f64>,
    /// Shape at root and tip, linear between; `None` when only resultants are known.
    pub shapes: Option<[Shape; 2]>,
    /// Whether it is known out of the plane, too.
    pub is_blade: bool,
    /// Length of the blade that it is of, where its deck says it \[m\].
    pub length: Option<f64>,
    /// The deck of matrices that it is of, and whether that has a line of its own.
    pub deck: Option<(Arc<Deck>, bool)>,
    pub(super) spatial: Spatial,
}

impl fmt::Debug for Section {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.planar.fmt(f)
    }
}

impl Section {
    /// A section known by its resultants in the plane: as that of a blade it is as stiff out of it.
    pub(super) fn planar(section: impl section::Section + 'static) -> Section {
        let planar: Arc<dyn section::Section> = Arc::new(section);
        let blade = Arc::clone(&planar);
        let spatial: Spatial = Arc::new(move |_| Ok(Box::new(PlanarBlade(Box::new(Arc::clone(&blade))))));
        Section { planar, height: None, shapes: None, is_blade: false, length: None, deck: None, spatial }
    }

    /// The section of a blade, of a material of which this is assumed.
    ///
    /// # Errors
    /// [`SectionError`] when the section makes no blade.
    pub fn blade(&self, assumed: Assumed) -> Result<Box<dyn BladeSection>, SectionError> {
        (self.spatial)(assumed)
    }

    /// The keys of the moments of inertia in bending that are 0, and what to write.
    pub(super) fn lacks_inertia(&self, of: &BladeResultants) -> [String; 2] {
        let keys = match self.deck {
            Some(_) => ["the column `inertia-chord`", "the column `inertia-flap`"],
            None => ["`rotary-inertia`", "`rotary-inertia-across`"],
        };
        let each = [(of.chord_inertia, of.chord_stiffness), (of.flap_inertia, of.flap_stiffness)];
        let lacking: Vec<(&str, String)> = each
            .into_iter()
            .zip(keys)
            .filter(|((inertia, _), _)| !(*inertia > 0.0))
            .map(|((_, stiffness), key)| {
                (key, format!("{:.4e} kg·m for {key}", of.mass * stiffness / of.axial_stiffness))
            })
            .collect();
        let names: Vec<&str> = lacking.iter().map(|(key, _)| *key).collect();
        let sizes: Vec<&str> = lacking.iter().map(|(_, size)| &**size).collect();
        let help = format!(
            "give the moment of inertia per length ρI; of one material it is m EI/EA, here {}; without shear, leave `shear` out",
            sizes.join(" and ")
        );
        [names.join(" and "), help]
    }
}
