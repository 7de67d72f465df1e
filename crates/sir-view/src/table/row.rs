//! Tables, their rows, columns and valid values.

use std::path::Path;

use glam::DVec3;
use sir_geom::Rgb;
use sir_mesh::Per;

use crate::error::ViewError;

/// One active side of a patch, or a part of the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Number of the patch, of the triangle in the scene's file, or of the face, from 0. Number of the row if the parts are
    /// materials or groups.
    pub number: u32,
    /// Number of the first triangle in the scene's file, from 0; 0 if the parts are materials or groups.
    pub triangle: u32,
    /// Area \[m²\], including gaps; of materials and groups, that of all sides that reflect or emit.
    pub area: f64,
    /// Center of area \[m\]; zero if the parts are materials or groups.
    pub center: DVec3,
    /// Unit normal on this side; zero if the parts are materials or groups.
    pub normal: DVec3,
    /// Radiosity `B` \[W/m²\], mean over what is not gap.
    pub radiosity: Rgb,
    /// Irradiance `E` \[W/m²\], mean over what is not gap.
    pub irradiance: Rgb,
    /// Standard error of the radiosity \[W/m²\]; zero where it is not known.
    pub error: Rgb,
    /// Standard error of the irradiance \[W/m²\]; zero where it is not known.
    pub irradiance_error: Rgb,
}

/// Light in numbers: one row per active side of every patch, in the order of side numbers; or one row per part of the scene.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Table {
    /// What the rows are; `None` if they are sides of patches.
    pub per: Option<Per>,
    /// The rows.
    pub rows: Vec<Row>,
    /// Names of the rows if they are materials or groups; otherwise empty.
    pub names: Vec<String>,
}

/// Names of the columns that hold numbers with a fraction, in file order.
const NUMBERS: [&str; 19] = [
    "area", "cx", "cy", "cz", "nx", "ny", "nz", "B_r", "B_g", "B_b", "E_r", "E_g", "E_b", "se_r", "se_g",
    "se_b", "seE_r", "seE_g", "seE_b",
];

/// The columns of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Columns {
    per: Option<Per>,
}

impl Columns {
    /// All kinds of tables. A table of faces has a column of triangles, too, so it comes before that of triangles.
    pub(super) const ALL: [Self; 5] = [
        Self::of(None),
        Self::of(Some(Per::Face)),
        Self::of(Some(Per::Triangle)),
        Self::of(Some(Per::Material)),
        Self::of(Some(Per::Group)),
    ];

    /// Returns the columns of a table of patches, or of these parts.
    pub(super) const fn of(per: Option<Per>) -> Self {
        Self { per }
    }

    pub(super) fn per(self) -> Option<Per> {
        self.per
    }

    /// Returns the name of the column that tells what a row is.
    pub(super) fn key(self) -> &'static str {
        match self.per {
            None => "patch",
            Some(Per::Triangle) => "triangle",
            Some(Per::Face) => "face",
            Some(Per::Material) => "material",
            Some(Per::Group) => "group",
        }
    }

    /// True if rows have a name instead of a number.
    pub(super) fn has_names(self) -> bool {
        matches!(self.per, Some(Per::Material | Per::Group))
    }

    /// Returns the names of the columns that hold whole numbers.
    pub(super) fn whole(self) -> &'static [&'static str] {
        match self.per {
            None => &["patch", "triangle"],
            Some(Per::Triangle) => &["triangle"],
            Some(Per::Face) => &["face", "triangle"],
            Some(Per::Material | Per::Group) => &[],
        }
    }

    /// Returns the places in [`NUMBERS`] of the columns after the first, which hold numbers with a fraction.
    fn places(self) -> impl Iterator<Item = usize> + Clone {
        let has_names = self.has_names();
        (0..NUMBERS.len()).filter(move |place| !has_names || !(1..7).contains(place))
    }

    /// Returns the names of the columns that hold numbers with a fraction.
    pub(super) fn numbers(self) -> impl Iterator<Item = &'static str> + Clone {
        self.places().map(|place| NUMBERS[place])
    }

    /// Returns the names of all columns, in file order.
    pub(super) fn names(self) -> Vec<&'static str> {
        let name = self.has_names().then(|| self.key());
        name.into_iter().chain(self.whole().iter().copied()).chain(self.numbers()).collect()
    }

    /// Returns the whole numbers of a row.
    pub(super) fn whole_of(self, row: &Row) -> impl Iterator<Item = u32> {
        [row.number, row.triangle].into_iter().take(self.whole().len())
    }

    /// Returns the other numbers of a row.
    pub(super) fn numbers_of(self, row: &Row) -> impl Iterator<Item = f64> {
        let Row { area, center, normal, radiosity, irradiance, error, irradiance_error, .. } = *row;
        let mut all = [area; NUMBERS.len()];
        let vectors = [center, normal, radiosity, irradiance, error, irradiance_error];
        for (slot, x) in all[1..].iter_mut().zip(vectors.iter().flat_map(|v| v.to_array())) {
            *slot = x;
        }
        self.places().map(move |place| all[place])
    }

    /// Creates the row with this index from checked values: the whole numbers, then the others.
    pub(super) fn row(self, index: usize, values: &[f64]) -> Row {
        let (whole, numbers) = values.split_at(self.whole().len());
        let mut all = [0.0; NUMBERS.len()];
        for (place, value) in self.places().zip(numbers) {
            all[place] = *value;
        }
        let vector = |i: usize| DVec3::new(all[i], all[i + 1], all[i + 2]);
        let number = whole.first().map_or(index as u32, |number| *number as u32);
        let of_triangles = if self.has_names() { 0 } else { number };
        Row {
            number,
            triangle: whole.get(1).map_or(of_triangles, |triangle| *triangle as u32),
            area: all[0],
            center: vector(1),
            normal: vector(4),
            radiosity: vector(7),
            irradiance: vector(10),
            error: vector(13),
            irradiance_error: vector(16),
        }
    }

    /// Returns the value if it is valid in a column, otherwise the reason why not.
    pub(super) fn checked(self, column: &str, value: f64) -> Result<f64, String> {
        if !value.is_finite() {
            Err(format!("{value} is not a finite number"))
        } else if self.whole().contains(&column)
            && (value.fract() != 0.0 || !(0.0..4_294_967_296.0).contains(&value))
        {
            Err(format!("{value} is not a whole number below 2³²"))
        } else if column == "area" && value <= 0.0 {
            Err(format!("an area must be positive, but this is {value}"))
        } else {
            Ok(value)
        }
    }
}

/// Creates the error for an invalid value in a row and column of a table file.
pub(super) fn bad_value(path: &Path, row: usize, column: &str, why: String) -> ViewError {
    ViewError::BadValue { path: path.to_owned(), row, column: column.to_owned(), why }
}
