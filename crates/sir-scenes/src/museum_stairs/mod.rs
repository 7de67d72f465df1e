//! The stair hall of a museum.
//!
//! Cool skylight falls through deep coffers into the middle of the hall. The rest of the hall is lit by reflection from
//! walls, floors and carpets, and by hidden warm lamps: in a trough on the cornice, in bowls on the pilasters, in the
//! great niche and under the caps of the vitrines. The only visible lamps are the globes on the stair.

mod balustrade;
mod coffers;
mod columns;
mod cornice;
mod floor;
mod gallery;
mod lamps;
mod palette;
mod pictures;
mod sculptor;
mod shell;
mod size;
mod stair;
mod statues;
mod vitrines;

use glam::DVec3;
use sir_geom::{Built, SceneBuilder, SceneError};

use crate::model::furnish::add_cameras;
use crate::model::sheet::lines;
use crate::model::{GAP, Model};
use palette::Palette;
use size::{FOOT, GALLERY, LENGTH};

/// Returns the stair hall of a museum, 16 m wide, 21 m long and 13 m high.
///
/// A wide flight leads to a landing, and two flights lead from there to a gallery on columns. The hall holds statues,
/// vases and paintings. It is closed: no light escapes.
///
/// The cameras are `top` from under the ceiling toward the stair, `foot` from the entrance, and `gallery` along the
/// gallery.
///
/// # Errors
///
/// None that can occur with the dimensions of the hall; the signature is the same for all scenes.
pub fn museum_stairs() -> Result<Built, SceneError> {
    let mut builder = SceneBuilder::new();
    let palette = Palette::new(&mut builder);
    let mut hall = shell::shell(&palette);
    for part in [
        coffers::fittings(&palette),
        columns::columns(&palette),
        gallery::gallery(&palette),
        cornice::cornice(&palette),
        stair::stair(&palette),
        runner(&palette),
        lamps::lamps(&palette),
        statues::statues(&palette),
        statues::benches(&palette),
        vitrines::vitrines(&palette),
        pictures::pictures(&palette),
    ] {
        hall.add_at(&part, 0.0, 0.0, 0.0);
    }
    hall.store(&mut builder);
    let views = [
        ("top", [2.0, 9.4, 18.35], [-0.3, 3.15, 5.0], 62.0),
        ("foot", [1.1, 1.65, 18.1], [-0.5, 4.6, 2.0], 62.0),
        ("gallery", [7.3, GALLERY + 1.75, 18.3], [2.9, GALLERY + 0.45, 3.0], 58.0),
    ];
    add_cameras(&mut builder, &views);
    builder.build()
}

/// Returns the carpet between the entrance and the stair.
fn runner(palette: &Palette) -> Model {
    let mut m = Model::default();
    let (half, border) = (stair::CARPET, stair::BORDER);
    let (from, to) = (FOOT + 0.02, LENGTH - 0.6);
    let x = [-half, border - half, -0.4, 0.4, half - border, half];
    let mut z = vec![from];
    z.extend(lines(from + border, to - border, 0.6));
    z.push(to);
    let color = |_, p: DVec3| {
        let edge = (half - p.x.abs()).min((p.z - from).min(to - p.z));
        if edge < border { palette.carpet_border } else { palette.carpet }
    };
    m.grid_block([&x, &[GAP, 0.012], &z], color);
    m
}
