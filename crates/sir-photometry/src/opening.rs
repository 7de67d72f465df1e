//! The luminous opening of a luminaire.

/// Luminous opening: the part of a luminaire that looks bright. Its center is the position of the luminaire, and lengths are
/// in meters. They are not negative; one that is zero makes a line or a vertical face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Opening {
    /// No extent.
    Point,
    /// Flat, in the plane perpendicular to the aim.
    Flat {
        /// Shape of the outline.
        outline: Outline,
        /// Extent along the x axis of the luminaire.
        length: f64,
        /// Extent along its y axis.
        width: f64,
    },
    /// Box or cylinder with luminous sides.
    Solid {
        /// Shape of the cross section perpendicular to the aim.
        outline: Outline,
        /// Extent along the x axis of the luminaire.
        length: f64,
        /// Extent along its y axis.
        width: f64,
        /// Extent along the aim.
        height: f64,
    },
    /// Ellipsoid; a sphere, such as a globe, if all extents are equal.
    Ellipsoid {
        /// Extent along the x axis of the luminaire.
        length: f64,
        /// Extent along its y axis.
        width: f64,
        /// Extent along the aim.
        height: f64,
    },
    /// Cylinder that lies across the aim, such as a fluorescent tube. Its cross section is an ellipse.
    Tube {
        /// Direction of its axis.
        along: Along,
        /// Extent along the x axis of the luminaire.
        length: f64,
        /// Extent along its y axis.
        width: f64,
        /// Extent along the aim.
        height: f64,
    },
}

/// Shape of an opening, perpendicular to the aim.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outline {
    /// Rectangle.
    Rectangle,
    /// Ellipse; a disc if length and width are equal.
    Ellipse,
}

/// Direction of a tube.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Along {
    /// The x axis of the luminaire, its length.
    Length,
    /// Its y axis, its width.
    Width,
}
