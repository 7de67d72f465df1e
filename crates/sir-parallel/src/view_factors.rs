//! View factors, counted by a crew.

use std::ops::Range;

use sir_radiosity::{Books, Grouping, Model, ViewFactorLines, ViewFactorSettings, ViewFactors, Visitor};

use crate::crew::Crew;
use crate::crew::{Position, Shift, Work};
use crate::error::RunError;

impl Work for ViewFactorLines<'_> {
    fn trace(&self, _thread: usize, lines: Range<u64>, books: &mut Books) {
        self.trace(lines, books);
    }

    fn visit(&mut self, visitor: &mut dyn Visitor) {
        self.visit(visitor);
    }
}

/// Counts the view factors between groups of surfaces, until they are accurate enough or all lines are traced. The result is the
/// same on all ranks.
///
/// # Errors
///
/// If there are too many groups or too few lines for them, or the observer wants to stop.
pub fn view_factors(
    model: &Model,
    grouping: &Grouping,
    settings: ViewFactorSettings,
    crew: &mut Crew<'_>,
) -> Result<ViewFactors, RunError> {
    let mut stage = ViewFactorLines::new(model, grouping, settings)?;
    let mut shift = Shift::begin(crew, stage.expected(), &[5, model.mesh.side_count() as u64, settings.seed]);
    let mut position = Position::default();
    loop {
        shift.expect(stage.expected());
        let end = stage.lines().end;
        shift.trace(&mut stage, &mut position, end)?;
        shift.add_up(|visitor| stage.visit_round(visitor));
        if !stage.advance() {
            return Ok(stage.finish());
        }
    }
}
