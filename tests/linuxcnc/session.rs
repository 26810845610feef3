//! LinuxCNC as an ordinary user, since its realtime part refuses root: components installed, one session at a time.

use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

use rigidtap::config::MachineFile;

use super::record::{Row, rows};

const USER: &str = "rigidtap-test";
const MODULE_INCLUDE: &str = "/usr/share/linuxcnc/Makefile.modinc";
/// `.ci/run` sets it: there, a test that cannot run has failed.
const REQUIRED: &str = "RIGIDTAP_LINUXCNC";

/// What of a setpoint the simulated drives are connected to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Drives {
    /// Position, velocity, torque and force.
    Torque,
    /// Position and velocity.
    Velocity,
    /// Positions alone.
    Position,
}

impl Drives {
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Torque => "torque",
            Self::Velocity => "velocity",
            Self::Position => "position",
        }
    }
}

/// A LinuxCNC with the components, for this test alone.
pub(crate) struct Session {
    folder: PathBuf,
    /// LinuxCNC runs once on a host, whoever starts it: tests of other processes wait, too.
    _alone: File,
}

fn crate_root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn target() -> &'static Path {
    Path::new(env!("CARGO_TARGET_TMPDIR")).parent().expect("it is target/tmp")
}

pub(crate) fn built(file: &str) -> PathBuf {
    target().join("linuxcnc").join(file)
}

/// Runs to success; what it said.
pub(crate) fn run(command: &mut Command) -> String {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    let said = String::from_utf8_lossy(&[&output.stdout[..], &output.stderr[..]].concat()).into_owned();
    assert!(output.status.success(), "{command:?}\n{said}");
    said
}

/// Why LinuxCNC cannot be run here.
fn missing() -> Option<String> {
    for file in ["/usr/bin/linuxcnc", "/usr/bin/halrun", MODULE_INCLUDE] {
        if !Path::new(file).exists() {
            return Some(format!("{file} is missing: install linuxcnc-uspace and linuxcnc-uspace-dev"));
        }
    }
    let user = Command::new("id").arg("-u").output().ok()?;
    (user.stdout != b"0\n").then(|| "only root can install the components and run them as another user".to_owned())
}

/// The program ran to its end: one that LinuxCNC broke off because the servo thread was kept waiting ends quietly.
pub(crate) fn is_done(said: &str) -> bool {
    said.contains("headless: done") && !said.contains("command timeout")
}

impl Drop for Session {
    fn drop(&mut self) {
        if !std::thread::panicking() {
            let _ = fs::remove_dir_all(&self.folder);
        }
    }
}

impl Session {
    /// None where LinuxCNC cannot be run, which is said plainly; an error where it has to be.
    pub(crate) fn new(name: &str) -> Option<Self> {
        if let Some(reason) = missing() {
            assert!(std::env::var_os(REQUIRED).is_none(), "{reason}");
            // Past the test harness, which keeps what passing tests print.
            let _ = writeln!(std::io::stderr(), "linuxcnc: {name} was not run: {reason}");
            return None;
        }
        let alone = File::create(std::env::temp_dir().join("rigidtap-linuxcnc.lock")).expect("a lock can be made");
        alone.lock().expect("the lock can be waited for");
        if !Command::new("id").arg(USER).output().expect("id runs").status.success() {
            run(Command::new("useradd").args(["--create-home", "--shell", "/bin/bash", USER]));
        }
        let mut make = Command::new("make");
        make.args(["install", "-C"]).arg(crate_root().join("src/capi/linuxcnc"));
        run(make.env("CARGO", env!("CARGO")).env("CARGO_TARGET_DIR", target()));
        let folder = std::env::temp_dir().join(format!("rigidtap-linuxcnc-{name}"));
        let _ = fs::remove_dir_all(&folder);
        run(Command::new("cp").arg("-r").arg(crate_root().join("src/capi/linuxcnc/sample")).arg(&folder));
        let session = Self { folder, _alone: alone };
        // What a session that was killed has left.
        run(&mut session.as_user("halrun -U", &[]));
        Some(session)
    }

    pub(crate) fn write(&self, file: &str, text: &str) -> &Self {
        fs::write(self.folder.join(file), text).unwrap_or_else(|error| panic!("{file}: {error}"));
        self
    }

    /// Sets a key of the sample's INI file.
    pub(crate) fn set(&self, key: &str, value: &str) -> &Self {
        let ini = fs::read_to_string(self.folder.join("rigidtap.ini")).expect("the sample has it");
        let start = format!("{key} = ");
        assert_eq!(ini.lines().filter(|line| line.starts_with(&start)).count(), 1, "{key}");
        let lines =
            ini.lines().map(|line| if line.starts_with(&start) { format!("{start}{value}") } else { line.into() });
        self.write("rigidtap.ini", &lines.collect::<Vec<String>>().join("\n"))
    }

    /// A machine whose drives are connected in full; what differs from its file is in `[actual]`.
    pub(crate) fn machine(&self, file: &MachineFile) -> &Self {
        self.write("machine.toml", &file.to_toml()).write("machine.hal", &file.to_hal()).connect(Drives::Torque);
        if !file.actual.reports_effort {
            let hal = fs::read_to_string(self.folder.join("rigidtap.hal")).expect("just written");
            let reports = ["net z-force ", "net spindle-torque "];
            let kept = hal.lines().filter(|line| !reports.iter().any(|start| line.starts_with(start)));
            self.write("rigidtap.hal", &(kept.collect::<Vec<_>>().join("\n") + "\n"));
        }
        self
    }

    /// The sample's wiring, with as much of it connected as these drives take.
    pub(crate) fn connect(&self, drives: Drives) -> &Self {
        let hal = include_str!("../../src/capi/linuxcnc/sample/rigidtap.hal");
        let left_out: &[&str] = match drives {
            Drives::Torque => &[],
            Drives::Velocity => &["net z-effort ", "net spindle-effort "],
            Drives::Position => &["net z-effort ", "net spindle-effort ", "net z-velocity ", "net spindle-velocity "],
        };
        let is_kept = |line: &&str| !left_out.iter().any(|start| line.starts_with(start));
        let kept: Vec<&str> = hal.lines().filter(is_kept).collect();
        assert_eq!(kept.len() + left_out.len(), hal.lines().count(), "the sample's wiring has other names");
        self.write("rigidtap.hal", &(kept.join("\n") + "\n"))
    }

    fn as_user(&self, command: &str, environment: &[(&str, &str)]) -> Command {
        run(Command::new("chown").args(["-R", USER]).arg(&self.folder));
        let mut started = Command::new("setpriv");
        started.args(["--reuid", USER, "--regid", USER, "--init-groups", "bash", "-c", command]);
        started.current_dir(&self.folder).env("HOME", format!("/home/{USER}")).env_remove("DISPLAY");
        started.envs(environment.iter().copied()).stdin(std::process::Stdio::null());
        started
    }

    /// A program on the sample with what a user logs of it in `log.txt`, and the truth beside it in `truth.txt`.
    pub(crate) fn log(&self, program: &str) -> String {
        let sample = |file: &str| fs::read_to_string(self.folder.join(file)).expect("the sample has it");
        let without_load = |hal: &str| -> String {
            hal.lines().filter(|line| !line.starts_with("loadrt")).map(|line| format!("{line}\n")).collect()
        };
        let truth = without_load(include_str!("record.hal")).replace("sampler.0", "sampler.1");
        let hal = [
            include_str!("../../src/capi/linuxcnc/sample/rigidtap.hal"),
            "loadrt sampler cfg=fffffb,fffsssss depth=20000,20000\n",
            &without_load(&sample("log.hal")),
            &truth.replace("halsampler log.txt", "halsampler -c 1 truth.txt"),
        ];
        self.write("rigidtap.hal", &hal.concat());
        let environment = [("RIGIDTAP_PROGRAM", program), ("RIGIDTAP_SECONDS", "800")];
        let output =
            self.as_user("timeout 900 linuxcnc -r rigidtap.ini", &environment).output().expect("LinuxCNC starts");
        String::from_utf8_lossy(&[&output.stdout[..], &output.stderr[..]].concat()).into_owned()
    }

    pub(crate) fn folder(&self) -> &Path {
        &self.folder
    }

    /// A command in the sample's folder; what it prints.
    pub(crate) fn run(&self, command: &str) -> String {
        run(&mut self.as_user(command, &[]))
    }

    /// A HAL file by itself; what it prints.
    pub(crate) fn halrun(&self, hal: &str) -> String {
        self.write("test.hal", hal);
        run(&mut self.as_user("timeout 60 halrun -f test.hal", &[]))
    }

    /// The sample with a program or MDI lines, recorded each period.
    pub(crate) fn simulate(&self, environment: &[(&str, &str)]) -> (bool, String, Vec<Row>) {
        let hal = fs::read_to_string(self.folder.join("rigidtap.hal")).expect("the sample has it");
        if !hal.contains("halsampler") {
            self.write("rigidtap.hal", &format!("{hal}\n{}", include_str!("record.hal")));
        }
        let mut linuxcnc = self.as_user("timeout 900 linuxcnc -r rigidtap.ini", environment);
        let output = linuxcnc.output().expect("LinuxCNC starts");
        let said = String::from_utf8_lossy(&[&output.stdout[..], &output.stderr[..]].concat()).into_owned();
        let log = fs::read_to_string(self.folder.join("log.txt")).unwrap_or_else(|error| panic!("{error}\n{said}"));
        (is_done(&said), said, rows(&log))
    }
}
