//! Dilation: texels around charts take the light of their neighbors, because viewers interpolate between texels.

use crate::layout::Layout;
use crate::texels::Texels;

/// Gives the texels within a distance of covered ones the mean of the neighbors that have light. Returns true for each
/// texel that has light then.
pub(crate) fn dilate(texels: &mut Texels, layout: &Layout, distance: u32) -> Vec<bool> {
    let (width, height) = (layout.width as usize, layout.height as usize);
    let mut is_lit: Vec<bool> = (0..texels.light.len()).map(|i| texels.is_covered(i)).collect();
    let mut border: Vec<usize> = Vec::new();
    for step in 0..distance {
        let mut found = Vec::new();
        let mut consider = |i: usize, is_lit: &[bool]| {
            if is_lit[i] {
                return;
            }
            let (mut light, mut error, mut count) = ([0.0f32; 3], [0.0f32; 3], 0.0f32);
            for_each_neighbor(i, width, height, |j| {
                if is_lit[j] {
                    for band in 0..3 {
                        light[band] += texels.light[j][band];
                        error[band] += texels.error[j][band];
                    }
                    count += 1.0;
                }
            });
            if count > 0.0 {
                found.push((i, light.map(|x| x / count), error.map(|x| x / count)));
            }
        };
        if step == 0 {
            (0..is_lit.len()).for_each(|i| consider(i, &is_lit));
        } else {
            let mut next: Vec<usize> = Vec::new();
            border.iter().for_each(|&i| for_each_neighbor(i, width, height, |j| next.push(j)));
            next.sort_unstable();
            next.dedup();
            next.into_iter().for_each(|i| consider(i, &is_lit));
        }
        border.clear();
        for (i, light, error) in found {
            texels.light[i] = light;
            texels.error[i] = error;
            is_lit[i] = true;
            border.push(i);
        }
    }
    is_lit
}

/// Visits the neighbors of a texel, diagonal ones included, on its page.
fn for_each_neighbor(texel: usize, width: usize, height: usize, mut visit: impl FnMut(usize)) {
    let (x, row) = (texel % width, texel / width);
    let y = row % height;
    for dy in -1..=1isize {
        for dx in -1..=1isize {
            let inside = |at: usize, step: isize, size: usize| {
                at.checked_add_signed(step).filter(|&at| at < size).is_some()
            };
            if (dx, dy) != (0, 0) && inside(x, dx, width) && inside(y, dy, height) {
                visit(texel.wrapping_add_signed(dx + dy * width as isize));
            }
        }
    }
}
