//! Who works on which replica of multipath.

use std::collections::VecDeque;
use std::sync::Mutex;

use sir_radiosity::{Books, Multipath, MultipathSettings, Replica, Transported, Visitor};

use crate::checkpoint::Saved;
use crate::communicator::Communicator;
use crate::crew::{Position, Shift, each};
use crate::error::{CheckpointError, RunError};

/// The replicas of a transport. Those whose numbers leave the remainder `rank` when divided by the number of ranks belong
/// to this rank; its threads take them one after the other.
pub(crate) struct Replicas<'m> {
    stage: Multipath<'m>,
    settings: MultipathSettings,
    rank: u64,
    ranks: u64,
    /// What belongs to this rank and is not done yet. Those under way come first.
    waiting: VecDeque<Task>,
    position: Position,
}

/// A replica of this rank; it has a state once it is under way.
struct Task {
    number: u64,
    replica: Option<Replica>,
}

impl<'m> Replicas<'m> {
    pub(crate) fn new(stage: Multipath<'m>, settings: MultipathSettings, comm: &dyn Communicator) -> Self {
        let (rank, ranks) = (comm.rank() as u64, comm.size() as u64);
        let mut replicas =
            Self { stage, settings, rank, ranks, waiting: VecDeque::new(), position: Position::default() };
        replicas.waiting = replicas.mine().map(|number| Task { number, replica: None }).collect();
        replicas
    }

    /// The numbers of the replicas of this rank.
    fn mine(&self) -> impl Iterator<Item = u64> + use<> {
        (self.rank..self.settings.replicas).step_by(self.ranks as usize)
    }

    /// Traces all lines.
    pub(crate) fn run(&mut self, shift: &mut Shift<'_, '_>) -> Result<(), RunError> {
        loop {
            let mut left = [self.waiting.iter().map(|task| self.left_of(task)).sum::<u64>() as i64];
            shift.talk(|comm| comm.sum(&mut left));
            let left = left[0] as u64;
            let done = self.settings.lines - left;
            shift.progress(done);
            if left == 0 {
                if shift.is_late() {
                    self.save(shift)?;
                }
                return Ok(());
            }
            let orders = shift.orders();
            if orders.save {
                self.save(shift)?;
            }
            if orders.stop {
                return Err(RunError::Interrupted { done, total: self.settings.lines });
            }
            let workers = shift.comm().size() * shift.threads();
            self.trace(shift, (orders.slice / workers as u64).max(1));
            shift.traced(orders.slice.min(left));
        }
    }

    fn left_of(&self, task: &Task) -> u64 {
        let lines = self.settings.lines_of(task.number);
        task.replica.as_ref().map_or(lines.end - lines.start, Replica::lines_left)
    }

    /// Lets every thread trace some lines, of one replica or of several.
    fn trace(&mut self, shift: &mut Shift<'_, '_>, lines: u64) {
        let Self { stage, waiting, position, .. } = self;
        let threads = shift.threads().min(waiting.len());
        let queue = Mutex::new(std::mem::take(waiting));
        let take = || queue.lock().unwrap_or_else(std::sync::PoisonError::into_inner).pop_front();
        let work = |thread| {
            let (mut books, mut left) = (Books::default(), lines);
            while let Some(Task { number, replica }) = take() {
                let mut replica = replica.unwrap_or_else(|| stage.replica(number));
                let before = replica.lines_left();
                stage.trace(thread, &mut replica, left, &mut books);
                left -= before - replica.lines_left();
                if replica.lines_left() > 0 {
                    return (books, Some(Task { number, replica: Some(replica) }));
                }
                if left == 0 {
                    break;
                }
            }
            (books, None)
        };
        let outcomes = shift.tracing(|| each(0..threads, work));
        *waiting = queue.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
        for (part, task) in outcomes.into_iter().rev() {
            position.books += part;
            task.into_iter().for_each(|task| waiting.push_front(task));
        }
    }

    fn save(&mut self, shift: &mut Shift<'_, '_>) -> Result<(), CheckpointError> {
        let left = self.table(shift);
        let mut position = self.position;
        shift.save(&mut position, &mut |visitor| self.show(&left, visitor))
    }

    /// How many lines are left in each replica.
    fn table(&self, shift: &mut Shift<'_, '_>) -> Vec<i64> {
        let mut left = vec![0; self.settings.replicas as usize];
        for task in &self.waiting {
            left[task.number as usize] = self.left_of(task) as i64;
        }
        shift.talk(|comm| comm.sum(&mut left));
        left
    }

    /// Shows everything to a visitor that saves: how many lines are `left` in each replica, what is common to all, and
    /// those under way.
    fn show(&mut self, left: &[i64], visitor: &mut dyn Visitor) {
        visitor.same(&mut left.to_vec());
        self.stage.visit(visitor);
        for number in self.under_way(left) {
            // All ranks take part; those that do not have the replica add zeros.
            let mine = self.waiting.iter_mut().find(|task| task.number == number);
            match mine.and_then(|task| task.replica.as_mut()) {
                Some(replica) => replica.visit(&mut AsSum { visitor, mine: true }),
                None => self.stage.replica(number).visit(&mut AsSum { visitor, mine: false }),
            }
        }
    }

    /// The replicas that are neither done nor untouched.
    fn under_way(&self, left: &[i64]) -> Vec<u64> {
        let lines = |number: u64| {
            let lines = self.settings.lines_of(number);
            (lines.end - lines.start) as i64
        };
        (0..self.settings.replicas).filter(|&n| (1..lines(n)).contains(&left[n as usize])).collect()
    }

    /// Puts back what was saved.
    pub(crate) fn restore(&mut self, saved: Saved, shift: &mut Shift<'_, '_>) -> Result<(), CheckpointError> {
        let mut left = vec![0; self.settings.replicas as usize];
        let mut tasks = VecDeque::new();
        let mut position = Position::default();
        shift.restore(saved, &mut position, &mut |visitor| {
            visitor.same(&mut left);
            self.stage.visit(visitor);
            for number in self.under_way(&left) {
                let mut replica = self.stage.replica(number);
                replica.visit(visitor);
                if number % self.ranks == self.rank {
                    tasks.push_back(Task { number, replica: Some(replica) });
                }
            }
        })?;
        let under_way = self.under_way(&left);
        let untouched = |n: &u64| left[*n as usize] > 0 && !under_way.contains(n);
        tasks.extend(self.mine().filter(untouched).map(|number| Task { number, replica: None }));
        (self.waiting, self.position) = (tasks, position);
        Ok(())
    }

    /// Adds up what all ranks have, and closes the books.
    pub(crate) fn finish(mut self, shift: &mut Shift<'_, '_>) -> Result<Transported, RunError> {
        shift.add_up(|visitor| {
            self.position.books.visit(visitor);
            self.stage.visit_counters(visitor);
        });
        Ok(self.stage.finish(self.position.books)?)
    }
}

/// Shows what one rank has as a sum over all ranks.
struct AsSum<'a> {
    visitor: &'a mut dyn Visitor,
    mine: bool,
}

impl Visitor for AsSum<'_> {
    fn sum(&mut self, words: &mut [i64]) {
        if !self.mine {
            words.fill(0);
        }
        self.visitor.sum(words);
    }

    fn same(&mut self, words: &mut [i64]) {
        self.sum(words);
    }
}
