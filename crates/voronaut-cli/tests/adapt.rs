//! `voronaut loop`: to a formula and through a solver; and `hessian:` metrics of the other commands.

use crate::common::{Place, stderr};
use serde_json::Value;

fn json(place: &Place, name: &str) -> Value {
    serde_json::from_slice(&place.read(name)).unwrap()
}

/// A solver in the shell's own language: the values of a function of x at the vertices, of a mesh in Medit's text.
const SOLVER: &str = r#"awk '/^Vertices/{getline n; print "MeshVersionFormatted 2\nDimension 2\nSolAtVertices\n" n "\n1 1"; for(i=0;i<n;i++){getline; d=20*($1-0.3-0.05*{step}); print (exp(d)-exp(-d))/(exp(d)+exp(-d))}}' {mesh} > {out}"#;

#[test]
fn ten_steps_of_a_moving_front() {
    let place = Place::new();
    let metric = "hessian:tanh(30*(sqrt((x-0.3-0.4*t)^2 + (y-0.5)^2) - 0.2))";
    let words = ["loop", "rect:0,0,1,1", "--metric", metric, "-n", "300", "--iterations", "10", "-o", "front.mesh"];
    let run = place.run(&[&words[..], &["--every", "--report", "loop.json"]].concat());
    assert!(run.status.success(), "{}", stderr(&run));
    assert_eq!(String::from_utf8_lossy(&run.stdout).lines().count(), 10);
    let report = json(&place, "loop.json");
    let steps = report["steps"].as_array().unwrap();
    let border = |step: &Value| step["boundary_vertices"].as_u64().unwrap();
    for (step, number) in steps.iter().zip(1..) {
        let name = format!("front.{number:02}.mesh");
        let checked = place.run(&["check", &name, "--domain", "rect:0,0,1,1", "-q"]);
        assert!(checked.status.success(), "{name}: {}", stderr(&checked));
        assert_eq!(step["vertices"], 300);
        assert!(border(step) as f64 <= 1.1 * border(&steps[0]) as f64, "{step}");
        if number > 1 {
            let [before, after] = ["before", "after"].map(|when| step["fields"][0][when][0]["mass"].as_f64().unwrap());
            assert!((after - before).abs() <= 1e-12 * before.abs(), "{before} {after}");
        }
    }
    // The mass of the last step is that of the first: what is carried is never made anew.
    let masses = |step: &Value, when: &str| step["fields"][0][when][0]["mass"].as_f64().unwrap();
    let (first, last) = (masses(&steps[1], "before"), masses(&steps[9], "after"));
    assert!((last - first).abs() <= 1e-10 * first.abs(), "{first} {last}");
    let carried = String::from_utf8(place.read("front.10.sol")).unwrap();
    assert!(carried.contains("SolAtVertices\n300\n2 1 1\n"), "{}", &carried[..200]);
}

#[test]
fn a_front_moves_over_a_sphere() {
    let place = Place::new();
    let metric = "hessian:tanh(12*(x - 0.5 + t))";
    let words =
        ["loop", "sphere:1", "--metric", metric, "-n", "300", "--iterations", "3", "-o", "front.mesh", "--every"];
    let run = place.run(&[&words[..], &["--report", "loop.json"]].concat());
    assert!(run.status.success(), "{}", stderr(&run));
    let report = json(&place, "loop.json");
    let steps = report["steps"].as_array().unwrap();
    let masses = |step: &Value, when: &str| step["fields"][0][when][0]["mass"].as_f64().unwrap();
    for (step, number) in steps.iter().zip(1..) {
        let name = format!("front.{number:02}.mesh");
        let function = format!("tanh(12*(x - 0.5 + {}))", 0.5 * f64::from(number - 1));
        let words = ["check", &name, "--domain", "sphere:1", "--function", &function, "--report", "check.json", "-q"];
        let checked = place.run(&words);
        assert!(checked.status.success(), "{name}: {}", stderr(&checked));
        // An even mesh of so many vertices has 0.1 to 0.2.
        let error = json(&place, "check.json")["interpolation"]["norm"].as_f64().unwrap();
        assert!(error < 0.05, "{name}: {error}");
        if number > 1 {
            let (before, after) = (masses(step, "before"), masses(step, "after"));
            assert!((after - before).abs() <= 1e-12 * before.abs().max(1.0), "{before} {after}");
        }
    }
    assert!(String::from_utf8(place.read("front.sol")).unwrap().contains("Dimension 3"));
}

#[test]
fn a_solver_is_run_on_meshes_of_a_surface() {
    let place = Place::new();
    let solver = SOLVER.replace("Dimension 2", "Dimension 3");
    let words = ["loop", "sphere:1", "--solver", &solver, "-n", "300", "--iterations", "2", "-o", "out.mesh"];
    let run = place.run(&[&words[..], &["--report", "loop.json"]].concat());
    assert!(run.status.success(), "{}", stderr(&run));
    let report = json(&place, "loop.json");
    assert!(report["steps"].as_array().unwrap()[1..].iter().all(|step| step["mass_drift"].as_f64().unwrap() < 1e-10));
    // The front is at x = 0.4 in the second step: there are the vertices.
    let mesh = String::from_utf8(place.read("out.mesh")).unwrap();
    let near = mesh.lines().filter_map(|line| line.split(' ').next()?.parse::<f64>().ok());
    let near = near.filter(|x| (x - 0.4).abs() < 0.15).count();
    assert!(near > 100, "{near}");
    let refused = place.run(&[&words[..], &["--recovery", "l2"]].concat());
    assert!(stderr(&refused).contains("--recovery on a surface"), "{}", stderr(&refused));
}

#[test]
fn a_solver_is_run_on_every_mesh() {
    let place = Place::new();
    let words = ["loop", "rect:0,0,1,1", "--solver", SOLVER, "-n", "300", "--iterations", "3", "-o", "out.mesh"];
    let run = place.run(&[&words[..], &["--report", "loop.json"]].concat());
    assert!(run.status.success(), "{}", stderr(&run));
    assert_eq!(place.files(), ["loop.json", "out.mesh", "out.sol"]);
    let report = json(&place, "loop.json");
    let steps = report["steps"].as_array().unwrap();
    assert_eq!(steps.len(), 4);
    assert!(steps[0]["fields"].is_null() && steps[3]["fields"][0]["components"] == 1);
    assert!(steps[1..].iter().all(|step| step["mass_drift"].as_f64().unwrap() < 1e-10));
    // The front is at x = 0.45 in the third step: there are the vertices.
    let mesh = String::from_utf8(place.read("out.mesh")).unwrap();
    let near = mesh.lines().filter_map(|line| line.split(' ').next()?.parse::<f64>().ok());
    assert!(near.filter(|x| (x - 0.45).abs() < 0.1).count() > 120);
}

/// Names of files are one word for the shell, in quotes or not.
#[test]
#[cfg(unix)]
fn a_directory_for_temporary_files_may_have_a_space_in_its_name() {
    let place = Place::new();
    std::fs::create_dir(place.path().join("it's here")).unwrap();
    for solver in [SOLVER.to_string(), SOLVER.replace("{out}", "\"{out}\"")] {
        let run = std::process::Command::new(env!("CARGO_BIN_EXE_voronaut"))
            .args(["loop", "rect:0,0,1,1", "--solver", &solver, "-n", "100", "--iterations", "1", "-o", "out.mesh"])
            .current_dir(place.path())
            .env("TMPDIR", place.path().join("it's here"))
            .output()
            .unwrap();
        assert!(run.status.success(), "{}", stderr(&run));
    }
}

#[test]
fn solvers_at_fault_are_named_and_leave_nothing() {
    let place = Place::new();
    for (solver, expected) in [
        ("exit 3 # {mesh} {out}", "solver: step 1: `exit 3"),
        ("true {mesh} {out}", "wrote no solution"),
        ("true {mesh}", "{out} is missing"),
        (
            "printf 'MeshVersionFormatted 2 Dimension 2 SolAtVertices 2 1 1 0.5 1' > {out} # {mesh}",
            "SolAtVertices has 2 entries, and the mesh 50 vertices",
        ),
        ("cp {mesh} {out}", "the solver's {out} of step 1"),
    ] {
        let words = ["loop", "rect:0,0,1,1", "--solver", solver, "-n", "50", "--iterations", "2", "-o", "out.mesh"];
        let run = place.run(&words);
        assert_eq!(run.status.code(), Some(1), "{solver}");
        assert!(stderr(&run).contains(expected) && stderr(&run).contains("help:"), "{solver}: {}", stderr(&run));
        assert!(place.files().is_empty(), "{:?}", place.files());
    }
}

#[test]
fn what_makes_no_loop_is_refused() {
    let place = Place::new();
    let base = ["loop", "rect:0,0,1,1", "-n", "50", "--iterations", "2"];
    for (more, code, expected) in [
        (&["--metric", "uniform", "-o", "a.mesh"][..], 1, "changes with nothing"),
        (&["--metric", "hessian:x^2 + z", "-o", "a.mesh"], 1, "use x, y and t"),
        (&["--metric", "hessian:x^2*t", "-o", "a.sol"], 1, "a.sol"),
        (&["--metric", "hessian:x", "-o", "a.mesh"], 1, "second derivatives vanish everywhere"),
        (&["-o", "a.mesh"], 2, "--metric"),
        (&["--metric", "hessian:x^2", "--solver", "x {mesh} {out}", "-o", "a.mesh"], 2, "cannot be used with"),
        (&["--metric", "hessian:x^2", "--time", "1", "-o", "a.mesh"], 2, "two times"),
    ] {
        let run = place.run(&[&base[..], more].concat());
        assert_eq!(run.status.code(), Some(code), "{more:?}: {}", stderr(&run));
        assert!(stderr(&run).contains(expected), "{more:?}: {}", stderr(&run));
        assert!(place.files().is_empty(), "{:?}", place.files());
    }
}

#[test]
fn a_hessian_of_a_file_is_that_of_its_formula() {
    let place = Place::new();
    let metric = "hessian:x^2 + 10*y^2";
    let words = ["mesh", "rect:0,0,1,1", "--metric", metric, "-n", "400", "-o", "a.mesh", "--report", "a.json"];
    assert!(place.run(&words).status.success());
    let mesh = String::from_utf8(place.read("a.mesh")).unwrap();
    let rows = mesh.split("Vertices").nth(1).unwrap().lines().skip(1).map(|line| line.trim().to_string());
    let rows: Vec<String> = rows.skip_while(|line| line.split(' ').count() < 2).take(400).collect();
    let value = |row: &String| {
        let [x, y]: [f64; 2] = std::array::from_fn(|i| row.split(' ').nth(i).unwrap().parse().unwrap());
        format!("{}\n", x * x + 10.0 * y * y)
    };
    let head = "MeshVersionFormatted 2\nDimension 2\nSolAtVertices 400\n1 1\n";
    place.put("a.sol", head.to_string() + &rows.iter().map(value).collect::<String>());
    let words = ["mesh", "rect:0,0,1,1", "--metric", "hessian:a.sol", "--background", "a.mesh", "-n", "400"];
    let run = place.run(&[&words[..], &["-o", "b.mesh", "--report", "b.json"]].concat());
    assert!(run.status.success(), "{}", stderr(&run));
    let error = |name| json(&place, name)["polished"]["error"].as_array().unwrap().last().unwrap().as_f64().unwrap();
    assert!((error("b.json") / error("a.json") - 1.0).abs() < 0.05, "{} {}", error("a.json"), error("b.json"));
    // Limits make it a metric like others.
    let words = ["mesh", "rect:0,0,1,1", "--metric", metric, "-n", "400", "--h-max", "0.2", "-o", "c.mesh"];
    assert!(place.run(&[&words[..], &["--report", "c.json"]].concat()).status.success());
    assert!(json(&place, "c.json")["polished"].is_null());
}
