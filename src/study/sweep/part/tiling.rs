//! Whether parts have every machine once.

use std::num::NonZeroU32;

use super::fault::MergeFault;
use super::shard::Shard;

/// A part by what it has.
pub(super) struct Tile {
    pub(super) name: String,
    pub(super) first_run: u32,
    pub(super) last_run: u32,
    pub(super) of: u32,
}

/// Machines that two parts have, and those that none has.
pub(super) fn faults(tiles: &[Tile], runs: NonZeroU32) -> Vec<MergeFault> {
    let mut sorted: Vec<_> = tiles.iter().collect();
    sorted.sort_by_key(|tile| tile.first_run);
    let mut faults = Vec::new();
    let (mut next, mut furthest): (u32, Option<&Tile>) = (1, None);
    for tile in &sorted {
        if tile.first_run > next {
            missing(next, tile.first_run - 1, &sorted, runs, &mut faults);
        } else if let Some(other) = furthest.filter(|_| tile.first_run < next) {
            faults.push(MergeFault::Overlap {
                names: [other.name.clone(), tile.name.clone()],
                runs: [tile.first_run, tile.last_run.min(other.last_run)],
            });
        }
        if tile.last_run >= next {
            (next, furthest) = (tile.last_run + 1, Some(*tile));
        }
    }
    if next <= runs.get() {
        missing(next, runs.get(), &sorted, runs, &mut faults);
    }
    faults
}

/// Each part in a gap by its name, where all parts are of one cut and it fits the gap.
fn missing(first: u32, last: u32, sorted: &[&Tile], runs: NonZeroU32, faults: &mut Vec<MergeFault>) {
    let of = sorted.first().map(|tile| tile.of).filter(|of| sorted.iter().all(|tile| tile.of == *of));
    let inside = |shard: &Shard| *shard.runs(runs).start() >= first && *shard.runs(runs).end() <= last;
    let parts: Vec<_> =
        of.iter().flat_map(|of| (1..=*of).filter_map(|number| Shard::new(number, *of))).filter(inside).collect();
    if parts.is_empty() {
        faults.push(MergeFault::Missing { runs: [first, last], shard: None });
    }
    faults.extend(parts.into_iter().map(|shard| {
        let runs = shard.runs(runs);
        MergeFault::Missing { runs: [*runs.start(), *runs.end()], shard: Some(shard) }
    }));
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(parts: &[(u32, u32)]) -> Vec<String> {
        let runs = NonZeroU32::new(100).unwrap();
        let tile = |(number, of): &(u32, u32)| {
            let runs = Shard::new(*number, *of).unwrap().runs(runs);
            Tile { name: format!("{number}of{of}"), first_run: *runs.start(), last_run: *runs.end(), of: *of }
        };
        let tiles: Vec<_> = parts.iter().map(tile).collect();
        faults(&tiles, runs).iter().map(|fault| fault.to_string().split(':').next().unwrap().to_owned()).collect()
    }

    #[test]
    fn every_machine_once_is_asked_for() {
        assert!(found(&[(3, 4), (1, 4), (4, 4), (2, 4)]).is_empty());
        // Of different cuts, as long as they fit.
        assert!(found(&[(1, 2), (3, 4), (4, 4)]).is_empty());
        assert_eq!(
            found(&[(1, 4), (4, 4)]),
            ["part 2/4 is missing, machines 26 to 50", "part 3/4 is missing, machines 51 to 75"]
        );
        assert_eq!(found(&[(1, 2), (4, 4)]), ["machines 51 to 75 are in no part"]);
        assert_eq!(
            found(&[(1, 1), (2, 2), (2, 4)]),
            ["1of1 and 2of4 both have machines 26 to 50", "1of1 and 2of2 both have machines 51 to 100",]
        );
        assert_eq!(found(&[]), ["machines 1 to 100 are in no part"]);
    }
}
