//! Bad input to the program: every line of these tables is refused with exit code 2, one message that names
//! the item, the field and the value, nothing on stdout, and never a panic.

use crate::shared_cli::{folder, lamina, run_file, write};

#[test]
fn a_bad_command_line_is_refused_by_name() {
    let table: &[(&str, &[&str])] = &[
        ("fly", &["unrecognized subcommand", "fly"]),
        ("run", &["<SCENE>"]),
        ("scenes --lanes 4", &["--lanes"]),
        ("run stack --bodes 3", &["--bodes"]),
        ("run nowhere", &["unknown scene", "'nowhere'", "free_flight"]),
        ("run nowhere/3", &["unknown scene", "'nowhere/3'"]),
        ("run stack/0", &["'stack'", "boxes", "'0'"]),
        ("run stack/x", &["'stack'", "boxes", "'x'"]),
        ("run stack/", &["'stack'", "boxes", "''"]),
        ("run stack/-3", &["'stack'", "boxes", "'-3'"]),
        ("run stack/3/4", &["'stack'", "boxes", "'3/4'"]),
        ("run head_on/1.5", &["'head_on'", "pairs", "'1.5'"]),
        ("run determinism/3", &["'determinism'", "nothing", "'3'"]),
        ("run polygons/9999999", &["'polygons'", "1000000", "'9999999'"]),
        ("run polygons --bodies 0", &["'polygons'", "bodies", "got 0"]),
        ("run polygons --bodies 9999999", &["'polygons'", "bodies", "got 9999999"]),
        ("run polygons --bodies -2", &["--bodies", "'-2'", "whole number"]),
        ("run determinism --bodies 3", &["'determinism'", "bodies", "got 3"]),
        ("run stack --steps 0", &["--steps", "at least 1", "got 0"]),
        ("run stack --steps -1", &["--steps", "'-1'", "whole number"]),
        ("run stack --steps x", &["--steps", "'x'", "whole number"]),
        ("run stack --steps 99999999999999999999", &["--steps", "'99999999999999999999'", "too large"]),
        ("run stack --dt 0", &["dt", "positive and finite", "got 0"]),
        ("run stack --dt -1", &["dt", "positive and finite", "got -1"]),
        ("run stack --dt nan", &["dt", "positive and finite", "got NaN"]),
        ("run stack --dt inf", &["dt", "positive and finite", "got inf"]),
        ("run stack --dt x", &["--dt", "'x'"]),
        ("run stack --dt 1e-300", &["dt", "f32", "got 1e-300"]),
        ("run stack --dt 1e300", &["dt", "f32", "got 1e300"]),
        ("run stack --lanes 3", &["lanes", "1, 4, 8 or 16", "got 3"]),
        ("run stack --lanes -4", &["--lanes", "'-4'"]),
        ("run stack --threads 0", &["--threads", "auto or 1 to 16", "'0'"]),
        ("run stack --threads 17", &["--threads", "auto or 1 to 16", "'17'"]),
        ("run stack --threads many", &["--threads", "auto or 1 to 16", "'many'"]),
        ("run stack --threads -1", &["--threads", "'-1'"]),
        ("run stack --lanes 16 --precision f64", &["lanes", "1 or 4", "f64", "got 16"]),
        ("run stack --integrator euler", &["integrator", "'euler'", "semi_implicit_euler"]),
        ("run stack --solver magic", &["solver", "'magic'", "impulse"]),
        ("run stack --broad tree", &["broad phase", "'tree'", "sweep"]),
        ("run stack --precision f16", &["precision", "'f16'", "f32"]),
        ("run stack --skip work", &["skip", "'work'", "closed_form"]),
        ("run stack --skip friction,work", &["skip", "'work'"]),
        ("run stack --substeps 0", &["substeps", "1 to 1000", "got 0"]),
        ("run stack --substeps 5000", &["substeps", "1 to 1000", "got 5000"]),
        ("run stack --max-sag 0", &["max-sag", "positive", "got 0"]),
        ("run stack --max-sag -1e-3", &["max-sag", "positive", "got -0.001"]),
        ("run stack --max-sag inf", &["max-sag", "finite", "got inf"]),
        ("run stack --max-sag nan", &["max-sag", "finite", "got NaN"]),
        ("run stack --max-sag 1e-3 --fixed-substeps", &["fixed-substeps", "max-sag"]),
        ("run stack --max-sag 1e-3 --solver xpbd", &["max-sag", "soft", "got xpbd"]),
        ("run stack --max-speed 0", &["max-speed", "positive", "got 0"]),
        ("run stack --max-speed nan", &["max-speed", "got NaN"]),
        ("run stack --max-speed x", &["--max-speed", "'x'"]),
        ("run stack --max-gain -1", &["max-gain", "positive", "got -1"]),
        ("run stack --max-gain inf", &["max-gain", "got inf"]),
        ("run stack --positions f16", &["positions", "'f16'", "f32"]),
        ("run stack --precision f64 --positions f32", &["positions", "f64", "got f32"]),
        ("stress t99_nothing", &["unknown case", "'t99_nothing'", "t01_column"]),
        ("stress --substeps 4,0", &["substeps", "1 to 1000", "got 0"]),
        ("stress --substeps x", &["--substeps", "'x'"]),
        ("stress --solver magic", &["solver", "'magic'", "soft"]),
        ("stress --precision f16", &["precision", "'f16'", "f32"]),
        ("run stack --seed x", &["--seed", "'x'"]),
        ("bench --bodies 3", &["--bodies"]),
        ("determinism now", &["'now'"]),
        ("report --out", &["--out"]),
        ("report --only lines", &["--only", "'lines'", "limits"]),
        ("report --only limits --publish", &["--only", "--publish"]),
        ("report --quick --against nowhere", &["--against", "nowhere"]),
    ];
    for (line, mentions) in table {
        lamina(&line.split(' ').collect::<Vec<_>>()).fails(2, mentions);
    }
}

#[test]
fn no_command_at_all_shows_the_commands() {
    let answer = lamina(&[]);
    assert_eq!(answer.code, Some(2), "{answer:#?}");
    assert!(answer.out.is_empty() && answer.err.contains("Usage: lamina <COMMAND>"), "{answer:#?}");
}

#[test]
fn a_file_that_cannot_be_a_scene_is_refused_by_path() {
    let folder = folder();
    std::fs::create_dir(folder.path().join("folder.toml")).unwrap();
    write(folder.path(), "latin.toml", b"about = \"\xe9t\xe9\"");
    write(folder.path(), "prose.toml", "This is not a scene.");
    write(folder.path(), "good.toml", "");
    let refused = |name: &str, more: &[&str], mentions: &[&str]| {
        let path = folder.path().join(name);
        let mut args = vec!["run", path.to_str().unwrap()];
        args.extend(more);
        lamina(&args).fails(2, mentions);
    };
    refused("missing.toml", &[], &["cannot read", "missing.toml", "No such file"]);
    refused("folder.toml", &[], &["cannot read", "folder.toml", "directory"]);
    refused("latin.toml", &[], &["cannot read", "latin.toml", "UTF-8"]);
    refused("prose.toml", &[], &["prose.toml", "line 1"]);
    refused("good.toml", &["--bodies", "3"], &["--bodies", "scene file"]);
    // Not a scene's name, and not called .toml.
    refused("prose.txt", &[], &["unknown scene", "prose.txt", ".toml"]);
}

#[test]
fn an_unknown_key_is_refused_at_every_level() {
    let body = "[[body]]\nshape = { circle = 1.0 }\nposition = [0, 0]\n";
    let table = [
        ("colour = 1".to_owned(), "`colour`"),
        ("[settings]\nspeed = 1".to_owned(), "`speed`"),
        ("[forces]\nlift = 1".to_owned(), "`lift`"),
        ("[forces.spring]\nanchor = [0, 0]\nstiffness = 1\ndamping = 1".to_owned(), "`damping`"),
        ("[forces.central]\ncenter = [0, 0]\nstrength = 1\nmass = 1".to_owned(), "`mass`"),
        (format!("{body}colour = 1"), "`colour`"),
        ("[[body]]\nshape = { disc = 1.0 }\nposition = [0, 0]".to_owned(), "`disc`"),
    ];
    for (text, key) in &table {
        run_file(text, &[]).fails(2, &["scene.toml", "line ", "unknown field", key]);
    }
}

#[test]
fn a_value_of_the_wrong_type_is_refused_with_its_line() {
    let table: &[(&str, &[&str])] = &[
        ("about = 3", &["about", "line 1", "string"]),
        ("body = 3", &["body", "line 1"]),
        ("[settings]\ndt = 'fast'", &["dt", "line 2", "\"fast\""]),
        ("[settings]\nsteps = -1", &["steps", "line 2", "-1"]),
        ("[settings]\nsteps = 1.5", &["steps", "line 2", "1.5"]),
        ("[settings]\nsubsteps = 99999999999", &["substeps", "line 2", "99999999999"]),
        ("[settings]\nintegrator = 'euler'", &["integrator", "line 2", "`euler`", "rk4"]),
        ("[settings]\nsolver = 'magic'", &["solver", "`magic`", "impulse"]),
        ("[settings]\nbroad = 'tree'", &["broad", "`tree`", "sweep"]),
        ("[settings]\nprecision = 'f16'", &["precision", "`f16`", "f32"]),
        ("[forces]\ngravity = -9.81", &["gravity", "line 2"]),
        // A third coordinate must not be lost without a word.
        ("[forces]\ngravity = [0, -9.81, 0]", &["gravity", "line 2", "two numbers", "got 3"]),
        ("[forces]\nspring = { anchor = [0], stiffness = 1 }", &["anchor", "line 2", "got 1"]),
        ("[[body]]\nshape = { circle = 1 }\nposition = [0, 0, 0]", &["position", "line 3", "got 3"]),
        ("[[body]]\nshape = { box = [1, 1, 1] }\nposition = [0, 0]", &["box", "line 2", "got 3"]),
        (
            "[[body]]\nshape = { polygon = [[0, 0], [1, 0, 2], [0, 1]] }\nposition = [0, 0]",
            &["polygon", "line 2", "got 3"],
        ),
        ("[forces]\nspring = { anchor = [0, 0] }", &["spring", "line 2", "`stiffness`"]),
        ("[[body]]\nposition = [0, 0]", &["line 1", "`shape`"]),
        ("[[body]]\nshape = { circle = 1.0 }", &["line 1", "`position`"]),
        ("[[body]]\nshape = { circle = 'big' }\nposition = [0, 0]", &["circle", "line 2", "\"big\""]),
        ("[[body]]\nshape = { circle = 1 }\nposition = [0]", &["position", "line 3"]),
        (
            "[[body]]\nshape = { circle = 1 }\nposition = [0, 0]\nkind = 'ghost'",
            &["kind", "line 4", "`ghost`"],
        ),
        ("[[body]]\nshape = {}\nposition = [0, 0]", &["line 2", "circle, box or polygon"]),
        (
            "[[body]]\nshape = { circle = 1, box = [1, 1] }\nposition = [0, 0]",
            &["line 2", "only one of circle, box or polygon"],
        ),
    ];
    for (text, mentions) in table {
        run_file(text, &[]).fails(2, &["scene.toml"]);
        run_file(text, &[]).fails(2, mentions);
    }
}

#[test]
fn a_bad_setting_in_a_file_is_refused_with_the_file() {
    let table: &[(&str, &[&str])] = &[
        ("dt = 0", &["dt", "got 0"]),
        ("dt = nan", &["dt", "got NaN"]),
        ("dt = -0.1", &["dt", "got -0.1"]),
        ("dt = 1e-300", &["dt", "f32", "got 1e-300"]),
        ("steps = 0", &["steps", "at least 1", "got 0"]),
        ("substeps = 0", &["substeps", "got 0"]),
        ("lanes = 3", &["lanes", "got 3"]),
        ("lanes = 8\nprecision = 'f64'", &["lanes", "1 or 4", "f64", "got 8"]),
        ("threads = 0", &["threads", "auto or 1 to 16", "'0'"]),
        ("threads = 17", &["threads", "auto or 1 to 16", "'17'"]),
        ("threads = 'all'", &["threads", "auto or 1 to 16", "'all'"]),
        ("max_sag = 0", &["max-sag", "got 0"]),
        ("max_sag = 1e-3\nfixed_substeps = true", &["fixed-substeps", "max-sag"]),
        ("stiffness = 0", &["stiffness", "got 0"]),
        ("stiffness = 0.6", &["stiffness", "at most 0.5", "got 0.6"]),
        ("stiffness = 0.1\nsolver = 'avbd'", &["stiffness", "soft", "avbd"]),
        ("skip = 'work'", &["skip", "'work'", "closed_form"]),
    ];
    for (line, mentions) in table {
        let answer = run_file(&format!("[settings]\n{line}"), &[]);
        answer.fails(2, &["scene.toml"]);
        answer.fails(2, mentions);
    }
}

#[test]
fn a_bad_shape_is_refused_with_its_body_and_vertex() {
    let table: &[(&str, &[&str])] = &[
        ("circle = 0", &["radius", "got 0"]),
        ("circle = -1", &["radius", "got -1"]),
        ("circle = nan", &["radius", "got NaN"]),
        ("circle = inf", &["radius", "got inf"]),
        ("circle = 1e30", &["shape size", "1e30"]),
        ("box = [0, 1]", &["half-extent x", "got 0"]),
        ("box = [1, -2]", &["half-extent y", "got -2"]),
        ("box = [1, inf]", &["half-extent y", "got inf"]),
        ("polygon = []", &["at least 3", "got 0"]),
        ("polygon = [[0, 0], [1, 0]]", &["at least 3", "got 2"]),
        (
            "polygon = [[4, 0], [3, 3], [0, 4], [-3, 3], [-4, 0], [-3, -3], [0, -4], [2, -3.5], [3, -3]]",
            &["at most 8", "got 9"],
        ),
        ("polygon = [[0, 0], [1, 0], [1, 0], [0, 1]]", &["vertex 2", "vertex 1"]),
        ("polygon = [[0, 0], [1, 0], [2, 0], [0, 1]]", &["vertex 1", "line"]),
        ("polygon = [[0, 0], [1, 1], [1, 0], [0, 1]]", &["crosses itself", "vertex 0", "vertex 2"]),
        ("polygon = [[0, 0], [4, 0], [4, 4], [3, 1]]", &["concave", "vertex 3"]),
        ("polygon = [[0, 0], [1, 0], [2, 0]]", &["no area"]),
        ("polygon = [[0, 0], [1, 0], [nan, 1]]", &["vertex 2", "not finite", "NaN"]),
        ("polygon = [[0, 0], [-inf, 0], [0, 1]]", &["vertex 1", "not finite", "-inf"]),
        ("polygon = [[0, 0], [1e200, 0], [0, 1]]", &["vertex 1", "too far", "1e200"]),
    ];
    for (shape, mentions) in table {
        let good = "[[body]]\nshape = { circle = 1 }\nposition = [9, 9]\n";
        let answer = run_file(&format!("{good}[[body]]\nshape = {{ {shape} }}\nposition = [0, 0]"), &[]);
        answer.fails(2, &["body 1"]);
        answer.fails(2, mentions);
    }
}

#[test]
fn a_bad_body_is_refused_with_its_number_and_field() {
    let table: &[(&str, &[&str])] = &[
        ("mass = 0", &["mass", "positive", "got 0"]),
        ("mass = -1", &["mass", "positive", "got -1"]),
        ("mass = nan", &["mass", "got NaN"]),
        ("mass = 1e60", &["mass", "precision", "1e60"]),
        ("density = 0", &["density", "got 0"]),
        ("density = -1", &["density", "got -1"]),
        ("mass = 1\ndensity = 2", &["mass or density", "mass 1", "density 2"]),
        ("restitution = 1.5", &["restitution", "0 to 1", "got 1.5"]),
        ("restitution = -0.5", &["restitution", "got -0.5"]),
        ("friction = -1", &["friction", "at least 0", "got -1"]),
        ("friction = nan", &["friction", "NaN"]),
        ("kind = 'static'\nvelocity = [0, 1]", &["static", "velocity", "got 1", "kinematic"]),
        ("kind = 'static'\nangular_velocity = 2", &["static", "angular_velocity", "got 2"]),
        ("angle = nan", &["angle", "NaN"]),
        ("velocity = [inf, 0]", &["velocity", "inf"]),
        ("velocity = [1e39, 0]", &["velocity", "precision", "1e39"]),
        ("force = [nan, 0]", &["force", "NaN"]),
        ("torque = inf", &["torque", "inf"]),
    ];
    for (line, mentions) in table {
        let text = format!("[[body]]\nshape = {{ circle = 1 }}\nposition = [0, 0]\n{line}");
        let answer = run_file(&text, &[]);
        answer.fails(2, &["body 0"]);
        answer.fails(2, mentions);
    }
    for (position, value) in [("[nan, 0]", "NaN"), ("[0, inf]", "inf"), ("[1e20, 0]", "1e20")] {
        let text = format!("[[body]]\nshape = {{ circle = 1 }}\nposition = {position}");
        run_file(&text, &[]).fails(2, &["body 0", "position", value]);
    }
}

/// Two discs 2 m apart and a static one between them; the second joint is bad.
#[test]
fn a_bad_joint_is_refused_with_its_number_and_field() {
    let body =
        |x: f64, more: &str| format!("[[body]]\nshape = {{ circle = 0.5 }}\nposition = [{x:?}, 0]\n{more}\n");
    let bodies = [body(-1.0, ""), body(1.0, ""), body(0.0, "kind = 'static'"), body(9.0, "kind = 'static'")];
    let good = "[[joint]]\nbodies = [0, 1]\nkind = { distance = {} }\n";
    let table: &[(&str, &str, &[&str])] = &[
        ("[0, 4]", "distance = {}", &["joint 1", "bodies", "no body 4", "has 4"]),
        ("[1, 1]", "distance = {}", &["joint 1", "bodies", "slot 2", "itself"]),
        ("[2, 3]", "distance = {}", &["joint 1", "dynamic", "static and static"]),
        ("[0, 1]", "distance = { length = 0 }", &["joint 1", "length", "positive", "got 0"]),
        ("[0, 1]", "distance = { length = -2 }", &["length", "got -2"]),
        ("[0, 1]", "distance = { length = nan }", &["length", "NaN"]),
        ("[0, 1]", "distance = { anchor_a = [3, 3], anchor_b = [3, 3] }", &["length", "got 0"]),
        ("[0, 1]", "distance = { anchor_a = [inf, 3] }", &["anchor_a", "inf"]),
        ("[0, 1]", "distance = { min = 3, max = 1 }", &["min", "above max", "3", "1"]),
        ("[0, 1]", "distance = { min = -1 }", &["min", "at least 0", "got -1"]),
        ("[0, 1]", "distance = { spring = { hertz = -3 } }", &["spring hertz", "positive", "got -3"]),
        ("[0, 1]", "distance = { spring = { hertz = 3, damping = -1 } }", &["spring damping", "got -1"]),
        ("[0, 1]", "revolute = { anchor = [nan, 0] }", &["anchor", "NaN"]),
        (
            "[0, 1]",
            "revolute = { anchor = [0, 0], limits = { lower = 1, upper = -1 } }",
            &["limits lower", "above limits upper", "1", "-1"],
        ),
        (
            "[0, 1]",
            "revolute = { anchor = [0, 0], motor = { speed = 1, max_torque = -5 } }",
            &["motor max_torque", "at least 0", "got -5"],
        ),
        (
            "[0, 1]",
            "revolute = { anchor = [0, 0], motor = { speed = 1, max_torque = inf } }",
            &["motor max_torque", "inf"],
        ),
        ("[0, 1]", "weld = { anchor = [0, inf] }", &["anchor", "inf"]),
        ("[0, 1]", "weld = { anchor = [0, 0], spring = { hertz = nan } }", &["spring hertz", "NaN"]),
        // Not a joint at all: refused with the file and its line.
        ("[0, 1, 2]", "distance = {}", &["scene.toml", "two bodies", "got 3"]),
        ("[0, -1]", "distance = {}", &["scene.toml", "-1"]),
        ("[0, 1]", "glue = {}", &["scene.toml", "`glue`", "`weld`"]),
        ("[0, 1]", "weld = { anchor = [0, 0], angle = 1 }", &["scene.toml", "`angle`"]),
        ("[0, 1]", "weld = {}", &["scene.toml", "`anchor`"]),
        ("[0, 1]", "weld = { anchor = [0, 0, 0] }", &["scene.toml", "two numbers", "got 3"]),
    ];
    for (ends, kind, mentions) in table {
        let text = format!("{}{good}[[joint]]\nbodies = {ends}\nkind = {{ {kind} }}\n", bodies.concat());
        run_file(&text, &["--steps", "1"]).fails(2, mentions);
    }
}

#[test]
fn a_bad_field_is_refused_by_name() {
    let table: &[(&str, &[&str])] = &[
        ("gravity = [0, nan]", &["gravity", "NaN"]),
        ("linear_drag = -1", &["linear_drag", "negative", "got -1"]),
        ("quadratic_drag = -0.5", &["quadratic_drag", "negative", "got -0.5"]),
        ("wind = [1, 0]", &["wind", "linear_drag or quadratic_drag"]),
        ("wind = [inf, 0]\nlinear_drag = 1", &["wind", "inf"]),
        ("magnetic = nan", &["magnetic", "NaN"]),
        ("spring = { anchor = [0, nan], stiffness = 1 }", &["spring", "NaN"]),
        ("central = { center = [0, 0], strength = inf }", &["central", "inf"]),
    ];
    for (line, mentions) in table {
        let answer = run_file(&format!("[forces]\n{line}"), &[]);
        answer.fails(2, &["force "]);
        answer.fails(2, mentions);
    }
}

#[test]
fn a_report_that_could_not_be_written_is_refused_before_anything_is_measured() {
    let folder = folder();
    let file = write(folder.path(), "taken", "");
    let file = file.to_str().unwrap();
    lamina(&["report", "--quick", "--out", file]).fails(2, &["--out", file, "not a folder"]);
    let below = format!("{file}/report");
    lamina(&["report", "--quick", "--out", &below]).fails(2, &["--out", "cannot write", &below]);
    if cfg!(target_os = "linux") {
        // A folder that exists, and takes no files even from root.
        lamina(&["report", "--quick", "--out", "/proc"]).fails(2, &["--out", "cannot write", "/proc"]);
    }
}
