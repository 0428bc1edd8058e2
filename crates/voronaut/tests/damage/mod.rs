//! Surfaces as they come: damaged at random, they are mended or refused by name; undamaged, they are left alone.

mod bases;
mod damages;
mod random;

use bases::{base, cube, renumbered};
use damages::{ALL, Done};
use random::Random;
use voronaut::manifold::surface::{Mended, RepairOptions, Surface, repaired};
use voronaut::mesh::Mesh;
use voronaut::quality::validity;

const MESHES: u64 = 200;

fn tried(mesh: &Mesh, repair: bool) -> Result<(Mesh, Mended), String> {
    let found = repaired(mesh, RepairOptions { repair }).map_err(|error| {
        assert!(!error.help().is_empty());
        error.to_string()
    })?;
    Surface::new(&found.0).expect("what comes out is a surface");
    Ok(found)
}

fn damaged(seed: u64) -> (Mesh, Vec<Done>) {
    let mut random = Random(seed);
    let mut mesh = base(&mut random);
    let mut done: Vec<Done> = (0..=random.below(3)).map(|_| ALL[random.below(ALL.len())]).collect();
    // One at least of each.
    done[0] = ALL[seed as usize % ALL.len()];
    for damage in &done {
        damage.apply(&mut mesh, &mut random);
    }
    (mesh, done)
}

#[test]
fn damaged_meshes_are_mended_or_refused_by_the_name_of_their_damage() {
    let mut counts = [0; 2];
    for seed in 0..MESHES {
        let (mesh, done) = damaged(seed);
        match tried(&mesh, false) {
            Ok(_) => counts[0] += 1,
            Err(said) => {
                let fits = done.iter().flat_map(|damage| damage.words()).any(|word| said.contains(word));
                assert!(fits, "{seed}: {done:?}, and yet {said}");
            }
        }
        match tried(&mesh, true) {
            Ok((made, _)) => {
                counts[1] += 1;
                assert_eq!(tried(&made, false).expect("a surface").0, made, "{seed}: mended, nothing is left to mend");
            }
            Err(said) => panic!("{seed}: {done:?}: {said}"),
        }
    }
    println!("{counts:?} of {MESHES} meshes without and with repair");
    assert!(counts[0] > MESHES / 4, "much is mended without repair: {counts:?}");
}

#[test]
fn single_damages_that_need_no_guess_are_mended_to_what_was_there() {
    for (seed, damage) in (0..20).flat_map(|seed| ALL.map(|damage| (seed, damage))) {
        let mut random = Random(seed);
        let mut mesh = base(&mut random);
        let before = Surface::new(&mesh).unwrap();
        let says_nothing = damage.words().is_empty();
        damage.apply(&mut mesh, &mut random);
        let found = tried(&mesh, !says_nothing);
        let (made, mended) = found.unwrap_or_else(|said| panic!("{seed} {damage:?}: {said}"));
        if damage == Done::Pinched || damage == Done::ThreeTriangleEdge || damage == Done::NotFinite {
            continue;
        }
        let after = Surface::new(&made).unwrap();
        let [before, after] = [&before, &after].map(|s| (s.euler_characteristic(), borders(s)));
        if matches!(damage, Done::Missing | Done::Holes) {
            continue;
        }
        assert_eq!(before, after, "{seed} {damage:?}: {:?}", mended.sentences().collect::<Vec<_>>());
    }
}

#[test]
fn refusals_name_a_single_damage() {
    for (seed, damage) in (0..15).flat_map(|seed| ALL.map(|damage| (seed, damage))) {
        let mut random = Random(1_000 + seed);
        let mut mesh = base(&mut random);
        damage.apply(&mut mesh, &mut random);
        if let Err(said) = tried(&mesh, false) {
            assert!(damage.words().iter().any(|word| said.contains(word)), "{damage:?}: {said}");
        }
        let never_passes = matches!(damage, Done::NotFinite);
        assert!(!never_passes || tried(&mesh, false).is_err());
    }
}

#[test]
fn holes_in_smooth_surfaces_are_closed() {
    for n in 4..8 {
        let mut random = Random(u64::from(n));
        let mut mesh = cube(n);
        Done::Missing.apply(&mut mesh, &mut random);
        let open = borders(&Surface::new(&tried(&mesh, false).unwrap().0).unwrap());
        let (made, mended) = tried(&mesh, true).unwrap();
        assert!(open > 0 && borders(&Surface::new(&made).unwrap()) == 0, "{mended:?}");
    }
}

#[test]
fn undamaged_surfaces_are_left_alone() {
    for seed in 0..100 {
        let mut random = Random(seed);
        let mesh = base(&mut random);
        let mesh = renumbered(&mesh, &mut random);
        for repair in [false, true] {
            let (made, mended) = tried(&mesh, repair).unwrap();
            assert_eq!(made, mesh, "{seed}");
            assert_eq!(mended, Mended::default(), "{seed}");
        }
    }
}

#[test]
fn numbers_and_orders_of_a_soup_do_not_matter() {
    for seed in 0..40 {
        let mut random = Random(seed);
        let mesh = base(&mut random);
        let before = Surface::new(&mesh).unwrap();
        let mut soup = renumbered(&mesh, &mut random);
        Done::Soup.apply(&mut soup, &mut random);
        let after = Surface::new(&tried(&soup, false).unwrap().0).unwrap();
        let [before, after] = [&before, &after].map(|s| (s.euler_characteristic(), borders(s), s.components().len()));
        assert_eq!(before, after, "{seed}");
    }
}

/// How many closed curves the border consists of.
fn borders(surface: &Surface) -> usize {
    validity(&surface.to_mesh()).boundary_loops
}
