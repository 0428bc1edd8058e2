//! `.sol` and `.solb`.
#![no_main]

use libfuzzer_sys::fuzz_target;
use voronaut_io::medit::Form;
use voronaut_io::sol;
use voronaut_fuzz::{PLACE, assert_same_values, read, written};

fuzz_target!(|input: &[u8]| {
    if let Some(solution) = read(input, || sol::read(input, PLACE)) {
        for form in [Form::Text, Form::Binary] {
            let file = written(|out| sol::write(&solution, form, out));
            let again = sol::read(file.as_slice(), PLACE).expect("its own file");
            assert_eq!(again.dimension, solution.dimension);
            assert_same_values(&again.values, &solution.values);
        }
    }
    let Some(solutions) = read(input, || sol::read_all(input, PLACE)) else { return };
    for form in [Form::Text, Form::Binary] {
        let file = written(|out| sol::write_all(&solutions, form, out));
        let again = sol::read_all(file.as_slice(), PLACE).expect("its own file");
        assert_eq!(again, solutions);
        let all = [(&again.vertices, &solutions.vertices), (&again.triangles, &solutions.triangles)];
        for (found, truth) in all.into_iter().flat_map(|(found, truth)| found.iter().zip(truth)) {
            assert_same_values(found, truth);
        }
    }
});
