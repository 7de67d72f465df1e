//! Runs with several processes, started by mpirun: bit-identical results for any number of ranks and threads, and
//! failures of single ranks. Needs the feature `mpi` and Open MPI.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "test helpers fail and print like tests")]

use std::fs;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Scene with escaping light, two-sided surfaces and several reflectances. Its tallies do not fit into one message.
const SCENE: &str = "mtllib room.mtl
v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 0 0 2\nv 2 0 2\nv 2 2 2\nv 0 2 2
v 0.5 0.5 0.5\nv 1.5 0.5 0.5\nv 1.5 0.6 1.5\nv 0.5 0.6 1.5
usemtl wall\nf 1 2 3 4\nf 6 5 8 7\nf 5 6 2 1
usemtl red\nf 2 6 7 3
usemtl lamp\nf 4 3 7 8
usemtl sheet\nf 9 12 11 10\n";
const MATERIALS: &str = "newmtl wall\nKd 0.5 0.5 0.75\nnewmtl red\nKd 0.75 0.125 0.125
newmtl lamp\nKd 0.25 0.25 0.25\nKe 1 0.5 0.25\nnewmtl sheet\nKd 0.5 0.5 0.5\n";

fn pipeline(local: u64, global: &str) -> String {
    format!(
        r#"(stages: [Load(path: "room.obj"), Subdivide(patches: 20_000), FirstShot(lines: {local}),
            Multipath(lines: {global}), Save([Table(path: "patches.npy")])])"#
    )
}

fn folder(pipeline: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in [("room.obj", SCENE), ("room.mtl", MATERIALS), ("room.ron", pipeline)] {
        fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

/// Returns the command `mpirun -n ranks sir arguments`, in a folder.
fn mpirun(folder: &Path, ranks: usize, arguments: &[&str]) -> Command {
    let mut command = Command::new("mpirun");
    // By default, Open MPI refuses to run as root or with more ranks than cores.
    command.env("OMPI_ALLOW_RUN_AS_ROOT", "1").env("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1");
    command.args(["--oversubscribe", "-n", &ranks.to_string(), env!("CARGO_BIN_EXE_sir")]).args(arguments);
    command.current_dir(folder);
    command
}

/// Returns exit code, standard output and standard error.
fn outcome(output: Output) -> (Option<i32>, String, String) {
    let text = |bytes| String::from_utf8_lossy(bytes).into_owned();
    (output.status.code(), text(&output.stdout), text(&output.stderr))
}

fn reap(child: Child) -> (Option<i32>, String, String) {
    outcome(child.wait_with_output().unwrap())
}

/// Returns the hash of the tallies of the last stage with lines, and the table.
fn result(run: &Path) -> (String, Vec<u8>) {
    let report = fs::read_to_string(run.join("result.json")).unwrap();
    let report: serde_json::Value = serde_json::from_str(&report).unwrap();
    let stages = report["stages"].as_array().unwrap();
    let hash = stages.iter().rev().find_map(|stage| stage["tally_hash"].as_str()).unwrap();
    (hash.to_owned(), fs::read(run.join("patches.npy")).unwrap())
}

#[test]
fn any_number_of_ranks_and_threads_gives_the_same_bits() {
    for global in ["60_000", "60_000, transport: Replicas", "60_000, transport: Replicas(count: 5, tail: 0)"]
    {
        let folder = folder(&pipeline(30_000, global));
        let folder = folder.path();
        let mut expected = None;
        for ranks in [1, 2, 3, 4] {
            for threads in ["1", "2", "3", "7"] {
                let arguments = ["run", "room.ron", "--out", "run", "--force", "--threads", threads];
                let (code, stdout, stderr) = outcome(mpirun(folder, ranks, &arguments).output().unwrap());
                assert_eq!(code, Some(0), "{stderr}");
                assert_eq!(stdout.matches("result.json").count(), 1, "only one rank must print: {stdout}");
                assert_eq!(stderr.matches("Multipath: 60_000 lines\n").count(), 1, "{stderr}");
                let found = result(&folder.join("run"));
                let expected = expected.get_or_insert_with(|| found.clone());
                assert!(found == *expected, "{ranks} ranks, {threads} threads, {global}: {}", found.0);
            }
        }
        println!("{global}: {}", expected.unwrap().0);
    }
}

#[test]
fn any_number_of_ranks_counts_the_same_view_factors() {
    let folder = folder("");
    let folder = folder.path();
    let found = |ranks, threads| {
        let arguments =
            ["viewfactors", "room.obj", "--error", "0.01", "--closure", "--json", "--threads", threads];
        let (code, stdout, stderr) = outcome(mpirun(folder, ranks, &arguments).output().unwrap());
        assert_eq!(code, Some(0), "{stderr}");
        serde_json::from_str::<serde_json::Value>(&stdout).unwrap()
    };
    let expected = found(1, "1");
    assert_eq!(expected["groups"].as_array().unwrap().len(), 4);
    for (ranks, threads) in [(1, "3"), (2, "1"), (3, "2")] {
        assert_eq!(found(ranks, threads), expected, "{ranks} ranks, {threads} threads");
    }
}

#[test]
fn a_mistake_is_shown_once_and_ends_all_ranks() {
    let folder = folder("(stages: [FirstShot(line: 3)])");
    let folder = folder.path();
    let (code, stdout, stderr) = outcome(mpirun(folder, 3, &["run", "room.ron"]).output().unwrap());
    assert_eq!((code, stdout.as_str()), (Some(2), ""), "{stderr}");
    assert_eq!(stderr.matches("unknown field `line`").count(), 1, "{stderr}");
    fs::write(folder.join("room.ron"), pipeline(10, "10")).unwrap();
    fs::write(folder.join("room.obj"), "f 1 2 3\n").unwrap();
    let (code, _, stderr) = outcome(mpirun(folder, 3, &["run", "room.ron"]).output().unwrap());
    assert_eq!(code, Some(1), "{stderr}");
    assert_eq!(stderr.matches("error: room.obj").count(), 1, "{stderr}");
    assert!(!folder.join("results").exists());
}

/// Runs every rank in its own folder. `change` is a shell command that modifies the files of rank 2.
fn in_own_folders(folder: &Path, change: &str) -> (Option<i32>, String, String) {
    let script = format!(
        "mkdir -p own-$OMPI_COMM_WORLD_RANK; cp room.* own-$OMPI_COMM_WORLD_RANK; cd own-$OMPI_COMM_WORLD_RANK
         if [ $OMPI_COMM_WORLD_RANK = 2 ]; then {change}; fi
         exec {} run room.ron --out run --quiet",
        env!("CARGO_BIN_EXE_sir")
    );
    let mut command = Command::new("mpirun");
    command.env("OMPI_ALLOW_RUN_AS_ROOT", "1").env("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1");
    command.args(["--oversubscribe", "-n", "3", "sh", "-c", &script]).current_dir(folder);
    outcome(command.output().unwrap())
}

#[test]
fn ranks_that_read_something_else_are_found_out() {
    let folder = folder(&pipeline(1_000, "1_000"));
    for (change, code, part) in [
        (
            "sed -i 's/lines: 1_000,/lines: 2_000,/; s/0.75/0.5/' room.ron room.mtl",
            1,
            "rank 2 has read another",
        ),
        ("rm room.obj", 2, "does not exist"),
        ("rm room.ron", 2, "cannot read the pipeline room.ron"),
        ("sed -i s/Ke.*// room.mtl", 1, "nothing in the scene emits light"),
    ] {
        let (found, _, stderr) = in_own_folders(folder.path(), change);
        assert_eq!(found, Some(code), "{change}: {stderr}");
        assert_eq!(stderr.matches(part).count(), 1, "{change}: {stderr}");
        assert!(!folder.path().join("own-0/run").exists(), "{change}");
    }
}

/// Starts a long run with checkpoints, and waits for the first checkpoint after some lines.
fn under_way(folder: &Path, ranks: usize) -> Child {
    let arguments = ["run", "room.ron", "--out", "run", "--checkpoint-every", "0.2", "--threads", "1"];
    let mut child =
        mpirun(folder, ranks, &arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let checkpoint = folder.join("run/checkpoint");
    while fs::metadata(&checkpoint).map_or(0, |file| file.len()) < 1_000_000 {
        assert!(child.try_wait().unwrap().is_none(), "the run ended before it could be interrupted");
        sleep(Duration::from_millis(20));
    }
    child
}

/// Resumes an interrupted run with other numbers of ranks and threads. Fails unless the result is that of an
/// uninterrupted run.
fn assert_resumes(folder: &Path, ranks: usize) {
    let arguments = ["resume", "run", "--threads", "2"];
    let (code, _, stderr) = outcome(mpirun(folder, ranks, &arguments).output().unwrap());
    assert_eq!(code, Some(0), "{stderr}");
    let whole = Command::new(env!("CARGO_BIN_EXE_sir"))
        .args(["run", "room.ron", "--out", "whole", "--quiet"])
        .current_dir(folder)
        .status();
    assert!(whole.unwrap().success());
    assert!(result(&folder.join("run")) == result(&folder.join("whole")));
}

/// Returns the processes whose parent is `child`. Works on Linux only.
fn ranks_of(child: &Child) -> Vec<u32> {
    let pid = child.id();
    let children = fs::read_to_string(format!("/proc/{pid}/task/{pid}/children")).unwrap();
    children.split_whitespace().map(|pid| pid.parse().unwrap()).collect()
}

fn kill(signal: &str, pid: u32) {
    Command::new("sh").args(["-c", &format!("kill {signal} {pid}")]).status().unwrap();
}

#[test]
fn a_killed_rank_ends_the_run_and_the_last_checkpoint_resumes() {
    for global in ["20_000_000", "20_000_000, transport: Replicas(count: 5)"] {
        let folder = folder(&pipeline(1_000_000, global));
        let child = under_way(folder.path(), 3);
        let ranks = ranks_of(&child);
        assert_eq!(ranks.len(), 3);
        let start = Instant::now();
        kill("-KILL", ranks[1]);
        let (code, _, stderr) = reap(child);
        assert!(start.elapsed() < Duration::from_secs(30), "the other ranks waited: {stderr}");
        assert!(code.is_some_and(|code| code != 0), "{code:?}: {stderr}");
        assert!(!folder.path().join("run/result.json").exists());
        assert_resumes(folder.path(), 2);
    }
}

/// Open MPI forwards SIGUSR1 immediately. After SIGTERM it waits for a second and then sends the ranks another one.
#[test]
fn signals_to_mpirun_save_the_state_of_all_ranks() {
    for signal in ["-USR1", "-TERM"] {
        let folder = folder(&pipeline(1_000_000, "30_000_000"));
        let child = under_way(folder.path(), 2);
        kill(signal, child.id());
        let (code, _, stderr) = reap(child);
        assert!(code.is_some_and(|code| code != 0), "{code:?}: {stderr}");
        assert_eq!(stderr.matches("error: interrupted after").count(), 1, "{signal}: {stderr}");
        assert_resumes(folder.path(), 3);
    }
}

/// If a checkpoint cannot be written, the first rank reports the error, and the others do not wait for it.
#[test]
fn an_error_of_one_rank_is_printed_once_and_ends_all() {
    let folder = folder(&pipeline(1_000_000, "6_000_000"));
    let script = format!(
        "trap '' XFSZ; [ $OMPI_COMM_WORLD_RANK = 0 ] && ulimit -f 100; exec {} run room.ron --out run --checkpoint-every 0",
        env!("CARGO_BIN_EXE_sir")
    );
    let mut command = Command::new("mpirun");
    command.env("OMPI_ALLOW_RUN_AS_ROOT", "1").env("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1");
    command.args(["--oversubscribe", "-n", "3", "sh", "-c", &script]).current_dir(folder.path());
    let (code, _, stderr) = outcome(command.output().unwrap());
    assert_eq!(code, Some(1), "{stderr}");
    assert_eq!(stderr.matches("error: ").count(), 1, "{stderr}");
    assert!(stderr.contains("error: cannot write the checkpoint run/checkpoint; "), "{stderr}");
    assert_resumes(folder.path(), 2);
}
