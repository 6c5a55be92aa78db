//! Messages between the program and its workers: a length, then numbers and byte strings one after another.

use std::ffi::OsStr;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

use crate::report::Failure;
use crate::reports::Done;

/// A message that is being written.
#[derive(Default)]
struct Message(Vec<u8>);

impl Message {
    fn number(&mut self, number: u64) {
        self.0.extend_from_slice(&number.to_le_bytes());
    }

    fn bytes(&mut self, bytes: &[u8]) {
        self.number(bytes.len() as u64);
        self.0.extend_from_slice(bytes);
    }

    fn send(&self, to: &mut impl Write) -> io::Result<()> {
        to.write_all(&(self.0.len() as u64).to_le_bytes())?;
        to.write_all(&self.0)?;
        to.flush()
    }
}

/// The bytes of the next message; `None` where there is no more.
pub(crate) fn receive(from: &mut impl Read) -> io::Result<Option<Vec<u8>>> {
    let mut length = [0; 8];
    match from.read_exact(&mut length) {
        Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => return Ok(None),
        result => result?,
    }
    let length = u64::from_le_bytes(length);
    let mut bytes = Vec::new();
    // As it comes, whatever the length claims.
    from.take(length).read_to_end(&mut bytes)?;
    if bytes.len() as u64 == length { Ok(Some(bytes)) } else { Err(io::ErrorKind::UnexpectedEof.into()) }
}

/// A message that is being read. What is missing reads as 0 or empty.
struct Reader<'a>(&'a [u8]);

impl<'a> Reader<'a> {
    fn number(&mut self) -> u64 {
        match self.0.split_first_chunk() {
            Some((number, rest)) => {
                self.0 = rest;
                u64::from_le_bytes(*number)
            }
            None => 0,
        }
    }

    fn bytes(&mut self) -> &'a [u8] {
        let length = usize::try_from(self.number()).unwrap_or(usize::MAX);
        let (bytes, rest) = self.0.split_at_checked(length).unwrap_or((&[], &[]));
        self.0 = rest;
        bytes
    }

    fn text(&mut self) -> String {
        String::from_utf8_lossy(self.bytes()).into_owned()
    }
}

/// Where an SVG comes from.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Source {
    File(PathBuf),
    /// What standard input held.
    Bytes(Vec<u8>),
}

/// What a worker is asked to do.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Task {
    pub(crate) source: Source,
    /// `None` stands for standard output: the answer holds what goes there.
    pub(crate) output: Option<PathBuf>,
    pub(crate) threads: usize,
}

impl Task {
    pub(crate) fn send(&self, to: &mut impl Write) -> io::Result<()> {
        let mut message = Message::default();
        message.number(self.threads as u64);
        match &self.source {
            Source::File(path) => {
                message.number(0);
                message.bytes(&path_to_bytes(path)?);
            }
            Source::Bytes(bytes) => {
                message.number(1);
                message.bytes(bytes);
            }
        }
        message.number(u64::from(self.output.is_some()));
        if let Some(path) = &self.output {
            message.bytes(&path_to_bytes(path)?);
        }
        message.send(to)
    }

    pub(crate) fn read(bytes: &[u8]) -> Self {
        let mut reader = Reader(bytes);
        let threads = usize::try_from(reader.number()).unwrap_or(1);
        let source = match reader.number() {
            0 => Source::File(bytes_to_path(reader.bytes())),
            _ => Source::Bytes(reader.bytes().to_vec()),
        };
        let output = (reader.number() == 1).then(|| bytes_to_path(reader.bytes()));
        Self { source, output, threads }
    }
}

/// Writes a worker's answer.
pub(crate) fn send_answer(answer: &Result<Done, Failure>, to: &mut impl Write) -> io::Result<()> {
    let mut message = Message::default();
    match answer {
        Ok(done) => {
            message.number(0);
            for number in [u64::from(done.width), u64::from(done.height)] {
                message.number(number);
            }
            for time in [done.parse, done.draw, done.encode] {
                message.number(u64::try_from(time.as_nanos()).unwrap_or(u64::MAX));
            }
            message.number(done.warnings.len() as u64);
            for warning in &done.warnings {
                message.bytes(warning.as_bytes());
            }
            message.bytes(&done.output);
        }
        Err(failure) => {
            message.number(1);
            message.bytes(failure.text().as_bytes());
        }
    }
    message.send(to)
}

/// Reads a worker's answer.
pub(crate) fn read_answer(bytes: &[u8]) -> Result<Done, Failure> {
    let mut reader = Reader(bytes);
    if reader.number() != 0 {
        return Err(Failure::new(reader.text()));
    }
    let [width, height] = [0; 2].map(|_| reader.number() as u32);
    let [parse, draw, encode] = [0; 3].map(|_| Duration::from_nanos(reader.number()));
    let count = reader.number();
    // A note takes eight bytes at least.
    let warnings = (0..count.min(bytes.len() as u64 / 8)).map(|_| reader.text()).collect();
    Ok(Done { width, height, parse, draw, encode, warnings, output: reader.bytes().to_vec() })
}

#[cfg(unix)]
fn path_to_bytes(path: &Path) -> io::Result<Vec<u8>> {
    use std::os::unix::ffi::OsStrExt as _;
    Ok(path.as_os_str().as_bytes().to_vec())
}

#[cfg(unix)]
fn bytes_to_path(bytes: &[u8]) -> PathBuf {
    use std::os::unix::ffi::OsStrExt as _;
    PathBuf::from(OsStr::from_bytes(bytes))
}

#[cfg(not(unix))]
fn path_to_bytes(path: &Path) -> io::Result<Vec<u8>> {
    let text: Option<&str> = OsStr::to_str(path.as_os_str());
    text.map(|text| text.as_bytes().to_vec()).ok_or_else(|| io::Error::other("its name is not Unicode"))
}

#[cfg(not(unix))]
fn bytes_to_path(bytes: &[u8]) -> PathBuf {
    PathBuf::from(String::from_utf8_lossy(bytes).into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tasks_and_answers_arrive_as_they_were_sent() {
        for task in [
            Task { source: Source::File("a/ä.svg".into()), output: Some("b.png".into()), threads: 3 },
            Task { source: Source::Bytes(b"<svg/>".to_vec()), output: None, threads: 0 },
        ] {
            let mut bytes = Vec::new();
            task.send(&mut bytes).unwrap();
            let mut bytes = bytes.as_slice();
            assert_eq!(Task::read(&receive(&mut bytes).unwrap().unwrap()), task);
            assert!(receive(&mut bytes).unwrap().is_none());
        }
        let done = Done {
            width: 3,
            height: 70_000,
            parse: Duration::from_nanos(5),
            draw: Duration::from_secs(7),
            encode: Duration::ZERO,
            warnings: vec!["one".to_owned(), String::new()],
            output: vec![0, 255],
        };
        let mut bytes = Vec::new();
        send_answer(&Ok(done), &mut bytes).unwrap();
        let done = read_answer(&receive(&mut bytes.as_slice()).unwrap().unwrap()).unwrap();
        assert_eq!((done.width, done.height, done.draw.as_secs()), (3, 70_000, 7));
        assert_eq!((done.warnings, done.output), (vec!["one".to_owned(), String::new()], vec![0, 255]));
        let mut bytes = Vec::new();
        send_answer(&Err(Failure::new("no")), &mut bytes).unwrap();
        let answer = read_answer(&receive(&mut bytes.as_slice()).unwrap().unwrap());
        assert_eq!(answer.err().map(|failure| failure.to_string()).as_deref(), Some("no"));
    }

    #[test]
    fn half_a_message_is_an_error_and_nonsense_is_read_as_something() {
        let mut bytes = Vec::new();
        send_answer(&Err(Failure::new("a failure")), &mut bytes).unwrap();
        for length in 8..bytes.len() {
            assert!(receive(&mut &bytes[..length]).is_err());
        }
        for length in 0..40 {
            let nonsense = vec![255; length];
            let _ = Task::read(&nonsense);
            let _ = read_answer(&nonsense);
            let _ = read_answer(&vec![0; length]);
        }
    }
}
