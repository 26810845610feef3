//! `rigidtap sweep`: whole, in parts, parts to the whole again, and a search for the worst machine.

mod part;
mod refusal;
mod setup;
mod whole;
mod words;
mod worst;

use super::args::{Common, SweepArgs};
use super::outcome::{Outcome, Stop};
use super::output;
use setup::Setup;

/// Taps one hole on many machines.
pub(super) fn sweep(common: &Common, args: &SweepArgs) -> Result<Outcome, Stop> {
    let mut read = vec![args.file.clone()];
    read.extend(args.merge.iter().cloned());
    let written = [&args.csv, &args.plot, &args.save_worst, &args.report, &args.out].map(Option::as_ref);
    output::check_paths(common, &read, &written)?;
    let setup = Setup::read(common, args)?;
    match (args.shard, &args.out) {
        (Some(shard), Some(path)) => part::part(common, args, &setup, shard, path),
        _ if args.worst => worst::worst(common, args, &setup),
        _ => whole::whole(common, args, &setup),
    }
}
