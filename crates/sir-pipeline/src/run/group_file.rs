//! Files of light groups: the light of a group after each stage, and its measurements, as exact numbers.
//!
//! A file consists of a line with the version of its layout, a line with the fingerprint of the run, a line with the number
//! of the group, and records in the order of the stages: the kind, the number of the stage, and the content, all as 64-bit
//! little-endian words. The SHA-256 of all of this ends it.

use std::fs::File;
use std::io::{self, BufRead as _, BufReader, Read, Seek as _, Write};
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};
use sir_geom::Rgb;
use sir_radiosity::{Measurement, ProbeMeasurement, Solution, SpreadOfMean};

use crate::error::Error;

/// First line: the file type and the version of its layout.
const MAGIC: &str = "SIR light group 2";

/// Length of a SHA-256 \[bytes\].
const HASH: u64 = 32;

/// Number that stands for a list that is not known.
const UNKNOWN: u64 = u64::MAX;

/// Kind of a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Light = 1,
    Sensors = 2,
    Probes = 3,
}

/// Light of a group after a stage.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct GroupLight {
    pub(super) solution: Solution,
    /// Direct irradiance, if it is needed and known.
    pub(super) direct: Option<Vec<Rgb>>,
    /// Standard errors of the irradiance and radiosity of the parts of each table, if they are known.
    pub(super) part_errors: Vec<Option<Vec<[Rgb; 2]>>>,
}

/// Measurements of a stage `Sensors`, with the errors of their mean if the spread of repeats tells them.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Measurements<T> {
    pub(super) all: Vec<T>,
    pub(super) spread: Option<SpreadOfMean>,
}

/// Returns the path of the file of a group in a run directory.
pub(super) fn path_of(directory: &Path, number: usize) -> PathBuf {
    directory.join(format!("group-{}.light", number + 1))
}

/// Removes the files of all groups of an older run from its directory.
pub(super) fn remove_all(directory: &Path) -> io::Result<()> {
    let mut number = 0;
    loop {
        match std::fs::remove_file(path_of(directory, number)) {
            Ok(()) => number += 1,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
            Err(error) => return Err(error),
        }
    }
}

/// Writes a file.
pub(super) struct GroupWriter<'w> {
    out: &'w mut dyn Write,
    hash: Sha256,
}

impl<'w> GroupWriter<'w> {
    /// Begins the file of the group with a number, from 0, in a run.
    pub(super) fn new(out: &'w mut dyn Write, number: usize, fingerprint: &str) -> io::Result<Self> {
        let mut writer = Self { out, hash: Sha256::new() };
        writer.write(format!("{MAGIC}\n{fingerprint}\n{}\n", number + 1).as_bytes())?;
        Ok(writer)
    }

    /// Writes the light after a stage.
    pub(super) fn light(&mut self, stage: usize, light: &GroupLight) -> io::Result<()> {
        let GroupLight { solution: Solution { irradiance, error }, direct, part_errors } = light;
        self.words(&[Kind::Light as u64, stage as u64])?;
        self.colors(Some(irradiance))?;
        self.colors(Some(error))?;
        self.colors(direct.as_deref())?;
        self.words(&[part_errors.len() as u64])?;
        part_errors.iter().try_for_each(|errors| self.colors(errors.as_ref().map(|e| e.as_flattened())))
    }

    /// Writes the measurements of sensors.
    pub(super) fn sensors(&mut self, stage: usize, measured: &Measurements<Measurement>) -> io::Result<()> {
        self.measurements(Kind::Sensors, stage, measured, |m| m.to_bits())
    }

    /// Writes the measurements of probes.
    pub(super) fn probes(
        &mut self,
        stage: usize,
        measured: &Measurements<ProbeMeasurement>,
    ) -> io::Result<()> {
        self.measurements(Kind::Probes, stage, measured, |m| m.to_words())
    }

    /// Ends the file.
    pub(super) fn finish(self) -> io::Result<()> {
        let hash: [u8; HASH as usize] = self.hash.finalize().into();
        self.out.write_all(&hash)
    }

    fn measurements<T: Copy, const N: usize>(
        &mut self,
        kind: Kind,
        stage: usize,
        Measurements { all, spread }: &Measurements<T>,
        to_words: impl Fn(T) -> [u64; N],
    ) -> io::Result<()> {
        self.words(&[kind as u64, stage as u64])?;
        match spread {
            None => self.words(&[UNKNOWN])?,
            Some(SpreadOfMean { error, covariances }) => {
                self.words(&[covariances.len() as u64, error.to_bits()])?;
                covariances.iter().try_for_each(|covariance| self.words(&[covariance.to_bits()]))?;
            }
        }
        self.words(&[all.len() as u64])?;
        all.iter().try_for_each(|&one| self.words(&to_words(one)))
    }

    fn colors(&mut self, colors: Option<&[Rgb]>) -> io::Result<()> {
        self.words(&[colors.map_or(UNKNOWN, |colors| colors.len() as u64)])?;
        colors
            .unwrap_or_default()
            .iter()
            .try_for_each(|color| self.words(&color.to_array().map(f64::to_bits)))
    }

    fn words(&mut self, words: &[u64]) -> io::Result<()> {
        words.iter().try_for_each(|word| self.write(&word.to_le_bytes()))
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.hash.update(bytes);
        self.out.write_all(bytes)
    }
}

/// Reads a file, record by record.
pub(super) struct GroupReader {
    path: PathBuf,
    file: io::Take<BufReader<File>>,
    /// Kind and stage of the next record; `None` at the end.
    next: Option<(u64, usize)>,
}

impl GroupReader {
    /// Opens the file of a group and verifies it.
    ///
    /// # Errors
    ///
    /// If it cannot be read, is damaged, or belongs to another group or to a run with another fingerprint.
    pub(super) fn open(directory: &Path, number: usize, fingerprint: &str) -> Result<Self, Error> {
        let path = path_of(directory, number);
        let refuse = |why: String| Error::GroupFile { path: path.clone(), why };
        let content = verified(&path).map_err(|error| refuse(error.to_string()))?;
        let Some(mut file) = content else { return Err(refuse("it is incomplete or damaged".into())) };
        let mut lines = [const { String::new() }; 3];
        for line in &mut lines {
            file.read_line(line).map_err(|error| refuse(error.to_string()))?;
        }
        if lines[0].trim_end() != MAGIC {
            return Err(refuse("it has another version".into()));
        }
        if lines[1].trim_end() != fingerprint {
            return Err(refuse(
                "it belongs to another run, or the pipeline or the scene has changed since".into(),
            ));
        }
        let of = lines[2].trim_end();
        if of != (number + 1).to_string() {
            return Err(refuse(format!("it is that of the light group {of}, not {}", number + 1)));
        }
        let mut reader = Self { path, file, next: None };
        reader.advance().map_err(|error| reader.damaged(&error))?;
        Ok(reader)
    }

    /// Returns the light after a stage, if the file has it. Stages must be asked for in their order.
    pub(super) fn light(&mut self, stage: usize) -> Result<Option<GroupLight>, Error> {
        self.record(Kind::Light, stage, |reader| {
            let irradiance = reader.colors()?.unwrap_or_default();
            let error = reader.colors()?.unwrap_or_default();
            let direct = reader.colors()?;
            let parts = reader.word()?;
            let pairs = |flat: Vec<Rgb>| flat.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect();
            let part_errors = (0..parts).map(|_| Ok(reader.colors()?.map(pairs)));
            let part_errors = part_errors.collect::<io::Result<_>>()?;
            Ok(GroupLight { solution: Solution { irradiance, error }, direct, part_errors })
        })
    }

    /// Returns the measurements of the sensors of a stage, if the file has them.
    pub(super) fn sensors(&mut self, stage: usize) -> Result<Option<Measurements<Measurement>>, Error> {
        self.record(Kind::Sensors, stage, |reader| reader.measurements(Measurement::from_bits))
    }

    /// Returns the measurements of the probes of a stage, if the file has them.
    pub(super) fn probes(&mut self, stage: usize) -> Result<Option<Measurements<ProbeMeasurement>>, Error> {
        self.record(Kind::Probes, stage, |reader| {
            reader.measurements(|words| ProbeMeasurement::from_words(&words))
        })
    }

    fn record<T>(
        &mut self,
        kind: Kind,
        stage: usize,
        read: impl FnOnce(&mut Self) -> io::Result<T>,
    ) -> Result<Option<T>, Error> {
        if self.next != Some((kind as u64, stage)) {
            return Ok(None);
        }
        let content = read(self).and_then(|content| self.advance().map(|()| content));
        content.map(Some).map_err(|error| self.damaged(&error))
    }

    fn damaged(&self, error: &io::Error) -> Error {
        Error::GroupFile { path: self.path.clone(), why: error.to_string() }
    }

    /// Reads the kind and the stage of the next record.
    fn advance(&mut self) -> io::Result<()> {
        self.next = match self.file.fill_buf()?.is_empty() {
            true => None,
            false => Some((self.word()?, self.word()? as usize)),
        };
        Ok(())
    }

    fn measurements<T, const N: usize>(&mut self, of: impl Fn([u64; N]) -> T) -> io::Result<Measurements<T>> {
        let spread = match self.word()? {
            UNKNOWN => None,
            count => {
                let error = f64::from_bits(self.word()?);
                let covariances = (0..count).map(|_| self.word().map(f64::from_bits));
                Some(SpreadOfMean { error, covariances: covariances.collect::<io::Result<_>>()? })
            }
        };
        let all = (0..self.word()?).map(|_| Ok(of(self.words()?))).collect::<io::Result<_>>()?;
        Ok(Measurements { all, spread })
    }

    fn colors(&mut self) -> io::Result<Option<Vec<Rgb>>> {
        match self.word()? {
            UNKNOWN => Ok(None),
            count => {
                let color = |_| Ok(Rgb::from_array(self.words()?.map(f64::from_bits)));
                (0..count).map(color).collect::<io::Result<_>>().map(Some)
            }
        }
    }

    fn words<const N: usize>(&mut self) -> io::Result<[u64; N]> {
        let mut words = [0; N];
        for word in &mut words {
            *word = self.word()?;
        }
        Ok(words)
    }

    fn word(&mut self) -> io::Result<u64> {
        let mut bytes = [0; 8];
        self.file.read_exact(&mut bytes)?;
        Ok(u64::from_le_bytes(bytes))
    }
}

/// Opens a file if its hash is right, up to that hash.
fn verified(path: &Path) -> io::Result<Option<io::Take<BufReader<File>>>> {
    let file = File::open(path)?;
    let Some(length) = file.metadata()?.len().checked_sub(HASH) else { return Ok(None) };
    let (mut content, mut hash) = (BufReader::new(file).take(length), Sha256::new());
    loop {
        let bytes = content.fill_buf()?;
        if bytes.is_empty() {
            break;
        }
        hash.update(bytes);
        let count = bytes.len();
        content.consume(count);
    }
    let mut file = content.into_inner();
    let mut stated = [0; HASH as usize];
    file.read_exact(&mut stated)?;
    if stated != <[u8; HASH as usize]>::from(hash.finalize()) {
        return Ok(None);
    }
    file.rewind()?;
    Ok(Some(file.take(length)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn light() -> GroupLight {
        let colors = |x: f64| vec![Rgb::new(x, 0.1, 1e-300), Rgb::splat(-x)];
        GroupLight {
            solution: Solution { irradiance: colors(1.0), error: colors(2.0) },
            direct: Some(colors(3.0)),
            part_errors: vec![None, Some(vec![[Rgb::ONE, Rgb::splat(0.3)]])],
        }
    }

    fn measurements() -> Measurements<Measurement> {
        let one = Measurement { irradiance: Rgb::new(1.0, 2.0, 3.0), rays: 7, ..Measurement::default() };
        let spread = Some(SpreadOfMean { error: 0.25, covariances: vec![0.5, -0.125] });
        Measurements { all: vec![one; 2], spread }
    }

    fn write(directory: &Path) {
        let mut out = Vec::new();
        let mut writer = GroupWriter::new(&mut out, 0, "abc").unwrap();
        writer.light(4, &light()).unwrap();
        writer.sensors(5, &measurements()).unwrap();
        let probes = Measurements { all: vec![ProbeMeasurement::default()], spread: None };
        writer.probes(6, &probes).unwrap();
        writer.finish().unwrap();
        std::fs::write(path_of(directory, 0), out).unwrap();
    }

    #[test]
    fn all_numbers_are_read_again() {
        let folder = tempfile::tempdir().unwrap();
        write(folder.path());
        let mut reader = GroupReader::open(folder.path(), 0, "abc").unwrap();
        assert_eq!(reader.light(3).unwrap(), None);
        assert_eq!(reader.light(4).unwrap(), Some(light()));
        assert_eq!(reader.light(5).unwrap(), None, "another kind");
        assert_eq!(reader.sensors(5).unwrap(), Some(measurements()));
        let probes = reader.probes(6).unwrap().unwrap();
        assert_eq!((probes.all, probes.spread), (vec![ProbeMeasurement::default()], None));
        assert!(reader.light(7).unwrap().is_none());
    }

    #[test]
    fn other_files_and_damaged_ones_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let why = |fingerprint| match GroupReader::open(folder.path(), 0, fingerprint) {
            Err(Error::GroupFile { why, .. }) => why,
            _ => String::new(),
        };
        assert!(!why("abc").is_empty(), "there is none");
        write(folder.path());
        assert_eq!(why("abc"), "");
        assert!(why("abd").contains("another run"));
        let path = path_of(folder.path(), 0);
        std::fs::copy(&path, path_of(folder.path(), 1)).unwrap();
        match GroupReader::open(folder.path(), 1, "abc") {
            Err(Error::GroupFile { why, .. }) => assert_eq!(why, "it is that of the light group 1, not 2"),
            _ => panic!("the file of another group is not refused"),
        }
        let mut bytes = std::fs::read(&path).unwrap();
        bytes[100] ^= 1;
        std::fs::write(&path, &bytes).unwrap();
        assert_eq!(why("abc"), "it is incomplete or damaged");
        std::fs::write(&path, &bytes[..20]).unwrap();
        assert_eq!(why("abc"), "it is incomplete or damaged");
        remove_all(folder.path()).unwrap();
        assert!(!path.exists());
    }
}
