//! Strangers that sail: ships of the zoo by their own laws, and ships whose laws it does not have.

use std::ops::Range;

use sistership_model::trial::Trial;
use sistership_model::{Model, Vessel, Zoo};
use sistership_simulation::Ship;
use sistership_tests::synthetic::{Orders, Trouble, replica, trial};
use sistership_tests::truth::instruments::Instruments;
use sistership_tests::truth::manoeuvre::{Manoeuvre, figures};
use sistership_tests::truth::motion::Truth;
use sistership_tests::truth::{self, family};

use crate::figures::{Figures, sailed};
use crate::ships::{bare, is_for_work};

/// Which strangers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Strangers {
    /// Of the zoo and of the truth, for work.
    Work,
    /// The same, for judgement.
    Judgement,
    /// Of the truth alone, by their seeds.
    Drawn(Range<u64>),
}

impl Strangers {
    fn seeds(&self) -> Range<u64> {
        match self {
            Self::Work => 1001..1009,
            Self::Judgement => 2001..2009,
            Self::Drawn(seeds) => seeds.clone(),
        }
    }

    fn has(&self, ship: &str) -> bool {
        match self {
            Self::Work => is_for_work(ship),
            Self::Judgement => !is_for_work(ship),
            Self::Drawn(_) => false,
        }
    }
}

/// What is fitted, first one, then all; rudder and change of heading, deg.
const FITTED: [Manoeuvre; 4] = [
    Manoeuvre::Zigzag(20.0, 20.0),
    Manoeuvre::Turn(35.0),
    Manoeuvre::Zigzag(-10.0, 10.0),
    Manoeuvre::Turn(-35.0),
];
/// What no call sees.
const UNSEEN: [Manoeuvre; 3] =
    [Manoeuvre::Zigzag(15.0, 15.0), Manoeuvre::Turn(-25.0), Manoeuvre::Zigzag(-15.0, 10.0)];

/// A stranger with its trials and the truth.
pub struct Sailed {
    /// Its particulars, without models.
    pub vessel: Vessel,
    /// Whether the zoo has its law.
    pub own_law: bool,
    /// Trials with noise.
    pub trials: Vec<Trial>,
    /// Trials without, that no call sees.
    pub unseen: Vec<Trial>,
    /// The true figures.
    pub figures: Figures,
}

/// Ships of the zoo, and ships whose laws it does not have.
pub fn strangers(zoo: &Zoo, of: &Strangers) -> Vec<Sailed> {
    let known = zoo.vessels().filter(|vessel| of.has(vessel.name()));
    let known = known.filter_map(|vessel| of_zoo(zoo, vessel));
    known.chain(of.seeds().filter_map(of_truth)).collect()
}

fn of_zoo(zoo: &Zoo, vessel: &Vessel) -> Option<Sailed> {
    let needed = ["lpp_m", "beam_m", "draught_m", "displacement_m3"];
    needed.iter().all(|name| vessel.particular(name).is_some()).then_some(())?;
    let model: Model = zoo.published_model(vessel, None).ok()?;
    let figures = sailed(zoo, &model).filter(Figures::complete)?;
    let ship = Ship::new(&model, zoo.law(&model.law)?).ok()?;
    let calm = Trouble { gusts: 0.0, scatter: 0.0, angles_deg: 0.0, ..Trouble::default() };
    let record = |all: &[Manoeuvre], trouble: &Trouble| -> Vec<Trial> {
        let one = |(k, manoeuvre): (usize, &Manoeuvre)| {
            let (orders, name) = (orders(*manoeuvre), manoeuvre.name());
            trial(&ship, &name, orders, manoeuvre.lengths(), trouble, &mut replica(1, 100 + k))
        };
        all.iter().enumerate().map(one).collect()
    };
    Some(Sailed {
        vessel: bare(vessel, &model),
        own_law: true,
        trials: record(&FITTED, &Trouble::default()),
        unseen: record(&UNSEEN, &calm),
        figures,
    })
}

fn orders(manoeuvre: Manoeuvre) -> Orders {
    match manoeuvre {
        Manoeuvre::Zigzag(rudder, switch) => Orders::Zigzag(rudder, switch),
        Manoeuvre::Turn(rudder) | Manoeuvre::PullOut(rudder) | Manoeuvre::Random(rudder, _) => {
            Orders::Turn(rudder)
        }
    }
}

fn of_truth(seed: u64) -> Option<Sailed> {
    let ship = family::single_screw(seed);
    let text = truth::files::vessel(ship.dimensions());
    let instruments = Instruments::of(&ship);
    let all = figures(&ship);
    let of = |name: &str| all.get(name).copied();
    let diameter_m = of("turn 35 deg: tactical diameter")?;
    Some(Sailed {
        vessel: Vessel::parse("truth", &text).unwrap(),
        own_law: false,
        trials: truth::trials(&ship, &FITTED, &instruments, seed),
        unseen: truth::trials(&ship, &UNSEEN, &instruments.without_noise(), seed),
        figures: Figures::new([
            Some(diameter_m / ship.dimensions().lpp_m),
            of("zigzag 10/10: first overshoot"),
            of("zigzag 20/20: first overshoot"),
        ]),
    })
}
