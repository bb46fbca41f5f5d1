//! Normal force and friction of a contact at a state.

use super::Proximity;
use crate::contact::obstacle::Surface;
use crate::linalg::Vec3;
use crate::linalg::vector::inner;

/// Normal force and friction of a contact at a state, with their derivatives by a variation.
pub(super) struct Forces {
    pub normal: f64,
    pub friction: [f64; 2],
    /// ∂N by g and ġ.
    pub by_gap: [f64; 2],
    /// ∂T by N, and by the sliding velocity.
    pub by_normal: [f64; 2],
    pub by_sliding: [[f64; 2]; 2],
}

impl Forces {
    pub fn vector(&self, surface: &Surface) -> Vec3 {
        let ([first, second], [t1, t2]) = (self.friction, surface.tangents);
        self.normal * surface.normal + first * t1 + second * t2
    }

    pub fn vanish(&self) -> bool {
        self.normal == 0.0 && self.friction == [0.0; 2]
    }

    /// Change of the force and its moment by changes of the `position` of the point, its `velocity` and the `spin`.
    pub fn change(&self, near: &Proximity, [position, velocity, spin]: [Vec3; 3]) -> [Vec3; 2] {
        let (Surface { normal: n, tangents: [t1, t2], .. }, radius) = (near.surface, near.motion.radius);
        let [dn, d1, d2] = near.turned(position);
        let gap = n.dot(position);
        let rate = dn.dot(near.velocity) + n.dot(velocity);
        let touching = if radius == 0.0 {
            velocity
        } else {
            velocity - radius * spin.cross(n) - radius * near.motion.spin.cross(dn)
        };
        let sliding = [(d1, t1), (d2, t2)].map(|(dt, t)| dt.dot(near.touching) + t.dot(touching));
        let normal = self.by_gap[0] * gap + self.by_gap[1] * rate;
        let [first, second] = [0, 1].map(|i| self.by_normal[i] * normal + inner(self.by_sliding[i], sliding));
        let turned = self.normal * dn + self.friction[0] * d1 + self.friction[1] * d2;
        let force = normal * n + first * t1 + second * t2 + turned;
        if radius == 0.0 {
            return [force, Vec3([0.0; 3])];
        }
        let turned = dn.cross(self.vector(&near.surface));
        [force, -radius * n.cross(force) - radius * turned]
    }
}
