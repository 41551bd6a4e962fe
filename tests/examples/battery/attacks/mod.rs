//! The attacks, a file each.

mod backups;
mod crash_points;
mod full_disk;
mod hostile;
mod kills;
mod memory;
mod neighbours;
mod outages;
mod races;
mod rights;
mod slow;
mod soak;
mod two_servers;
mod workers;

use crate::attack::Attack;

/// All of them, in the order of the table.
pub fn all() -> Vec<Box<dyn Attack>> {
    vec![
        Box::new(kills::Kills),
        Box::new(crash_points::CrashPoints),
        Box::new(full_disk::FullDisk),
        Box::new(hostile::Hostile),
        Box::new(memory::Memory),
        Box::new(slow::Slow),
        Box::new(races::Races),
        Box::new(workers::Workers),
        Box::new(backups::Backups),
        Box::new(outages::Outages),
        Box::new(neighbours::Neighbours),
        Box::new(rights::Rights),
        Box::new(two_servers::TwoServers),
        Box::new(soak::Soak),
    ]
}
