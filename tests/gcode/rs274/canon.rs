//! What `rs274 -g` prints, read back: canonical machining functions, one a line.

/// A tapped hole.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hole {
    pub(crate) x_mm: f64,
    pub(crate) y_mm: f64,
    pub(crate) r_plane_mm: f64,
    pub(crate) bottom_mm: f64,
    pub(crate) return_mm: f64,
    pub(crate) pitch_mm: f64,
    pub(crate) right: bool,
    pub(crate) dwell_s: f64,
}

/// What a program does, as far as it is compared.
#[derive(Debug)]
pub(crate) struct Run {
    /// Every point where the path begins, ends or turns.
    path_mm: Vec<[f64; 3]>,
    pub(crate) holes: Vec<Hole>,
    /// Pauses outside of holes.
    pub(crate) dwells_s: Vec<f64>,
}

impl Default for Run {
    fn default() -> Self {
        Self { path_mm: vec![[0.0; 3]], holes: Vec::new(), dwells_s: Vec::new() }
    }
}

impl Run {
    pub(crate) fn at_mm(&self) -> [f64; 3] {
        self.path_mm.last().copied().unwrap_or_default()
    }

    /// Points that are the same are one.
    pub(crate) fn go(&mut self, to_mm: [f64; 3]) {
        let same = self.at_mm().iter().zip(to_mm).all(|(from, to)| (from - to).abs() < 1e-4);
        if !same {
            self.path_mm.push(to_mm);
        }
    }

    /// Whether both do the same; else what differs first.
    pub(crate) fn compare(&self, other: &Self, tolerance_mm: f64) -> Result<(), String> {
        let close = |a: f64, b: f64| (a - b).abs() <= tolerance_mm;
        if self.holes.len() != other.holes.len() {
            return Err(format!("{} holes here, {} there", self.holes.len(), other.holes.len()));
        }
        for (number, (own, other)) in (1..).zip(self.holes.iter().zip(&other.holes)) {
            let values = |hole: &Hole| {
                let Hole { x_mm, y_mm, r_plane_mm, bottom_mm, return_mm, pitch_mm, right, dwell_s } = *hole;
                [x_mm, y_mm, r_plane_mm, bottom_mm, return_mm, pitch_mm, f64::from(u8::from(right)), dwell_s]
            };
            if !values(own).iter().zip(values(other)).all(|(a, b)| close(*a, b)) {
                return Err(format!("hole {number}:\n  here  {own:?}\n  there {other:?}"));
            }
        }
        let points = |run: &Self| run.path_mm.iter().flatten().copied().collect::<Vec<_>>();
        for (own, other, what) in
            [(points(self), points(other), "path"), (self.dwells_s.clone(), other.dwells_s.clone(), "dwells")]
        {
            if own.len() != other.len() || !own.iter().zip(&other).all(|(a, b)| close(*a, *b)) {
                return Err(format!("{what}:\n  here  {own:?}\n  there {other:?}"));
            }
        }
        Ok(())
    }
}

/// State of the reader.
#[derive(Debug)]
struct Reader {
    run: Run,
    unit_mm: f64,
    offset_mm: [f64; 3],
    /// G52, G92.
    shift_mm: [f64; 3],
    feed_mm: f64,
    per_revolution: bool,
    speed_rpm: f64,
    right: bool,
    synchronous_mm: f64,
    /// The strokes of a tapping cycle, from the point at its R plane.
    cycle: Option<(Vec<[f64; 3]>, bool, f64)>,
}

/// Reads all that is compared.
pub(crate) fn read(text: &str) -> Run {
    let mut reader = Reader {
        run: Run::default(),
        unit_mm: 1.0,
        offset_mm: [0.0; 3],
        shift_mm: [0.0; 3],
        feed_mm: 0.0,
        per_revolution: false,
        speed_rpm: 0.0,
        right: true,
        synchronous_mm: 0.0,
        cycle: None,
    };
    for line in text.lines() {
        // A number, a line number, the function.
        let behind = |text: &'_ str| text.trim_start().split_once(' ').map(|(_, rest)| rest.trim_start().to_owned());
        let function = behind(line).and_then(|rest| behind(&rest));
        if let Some((name, arguments)) = function.as_deref().and_then(|function| function.split_once('(')) {
            let arguments: Vec<_> = arguments.trim_end_matches(')').split(',').map(str::trim).collect();
            reader.function(name, &arguments);
        }
    }
    reader.run
}

impl Reader {
    fn function(&mut self, name: &str, arguments: &[&str]) {
        let number = |index: usize| -> f64 {
            let text = arguments.get(index).unwrap_or_else(|| panic!("{name} has argument {index}"));
            text.parse().unwrap_or_else(|_| panic!("{name}: {text} is a number"))
        };
        let mm = |index: usize| self.unit_mm * number(index);
        match name {
            "USE_LENGTH_UNITS" => self.unit_mm = if arguments[0] == "CANON_UNITS_INCHES" { 25.4 } else { 1.0 },
            "SET_G5X_OFFSET" => self.offset_mm = [mm(1), mm(2), mm(3)],
            "SET_G92_OFFSET" => self.shift_mm = [mm(0), mm(1), mm(2)],
            "SET_FEED_RATE" => self.feed_mm = mm(0),
            "SET_FEED_MODE" => self.per_revolution = number(1) != 0.0,
            "SET_SPINDLE_SPEED" => self.speed_rpm = number(1),
            "START_SPINDLE_CLOCKWISE" => self.right = true,
            "START_SPINDLE_COUNTERCLOCKWISE" => self.right = false,
            "START_SPEED_FEED_SYNC" => self.synchronous_mm = mm(0),
            "STRAIGHT_TRAVERSE" | "STRAIGHT_FEED" => self.straight([mm(0), mm(1), mm(2)]),
            "RIGID_TAP" => self.rigid_tap([mm(0), mm(1), mm(2)]),
            "DWELL" => match &mut self.cycle {
                Some((.., dwell_s)) => *dwell_s = number(0),
                None => self.run.dwells_s.push(number(0)),
            },
            "DISABLE_FEED_OVERRIDE" => self.cycle = Some((vec![self.run.at_mm()], self.right, 0.0)),
            "ENABLE_FEED_OVERRIDE" => self.end_cycle(),
            _ => {}
        }
    }

    fn machine(&self, point_mm: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|axis| point_mm[axis] + self.offset_mm[axis] + self.shift_mm[axis])
    }

    fn straight(&mut self, to_mm: [f64; 3]) {
        let to_mm = self.machine(to_mm);
        self.run.go(to_mm);
        if let Some((strokes, ..)) = &mut self.cycle {
            strokes.push(to_mm);
        }
    }

    fn rigid_tap(&mut self, to_mm: [f64; 3]) {
        let [x_mm, y_mm, bottom_mm] = self.machine(to_mm);
        let from_mm = self.run.at_mm();
        self.run.go([x_mm, y_mm, bottom_mm]);
        self.run.go(from_mm);
        self.run.holes.push(Hole {
            x_mm,
            y_mm,
            r_plane_mm: from_mm[2],
            bottom_mm,
            return_mm: from_mm[2],
            pitch_mm: self.synchronous_mm,
            right: self.right,
            dwell_s: 0.0,
        });
    }

    fn end_cycle(&mut self) {
        let Some((strokes, right, dwell_s)) = self.cycle.take() else { return };
        // Anything else is between M50 P0 and M50 P1, which switch the override, too. A cycle that were read so has no
        // hole, and the comparison shows it.
        let [from, bottom, back] = strokes[..] else { return };
        self.run.holes.push(Hole {
            x_mm: bottom[0],
            y_mm: bottom[1],
            r_plane_mm: from[2],
            bottom_mm: bottom[2],
            return_mm: back[2],
            pitch_mm: if self.per_revolution { self.feed_mm } else { self.feed_mm / self.speed_rpm },
            right,
            dwell_s,
        });
    }
}
