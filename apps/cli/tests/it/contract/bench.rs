//! `neurotess bench`, in small.

use crate::needs::gpu;
use crate::work::Work;

const SMALL: &str = "bench refinement --neurons 1,3 --levels 1,2 --grow 4 --distinct 2 --points 60 \
                     --frames 1 --size 48x48";

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn refinement_gives_tables_json_and_a_plot() {
    let work = Work::new();
    let json = work
        .run(&format!("{SMALL} --json -o figures"))
        .exits(0)
        .json();
    let rows = json["rows"].as_array().expect("rows");
    // Three ways at two levels, and two by the error, in two scenes.
    assert_eq!(rows.len(), 2 * (3 * 2 + 2));
    for row in rows {
        assert!(row["ms"].as_f64().is_some_and(|ms| ms > 0.0), "{row}");
        assert!(row["triangles"].as_u64().is_some_and(|n| n > 0), "{row}");
        assert!(row["bytes"].as_u64().is_some_and(|n| n > 0), "{row}");
    }
    let triangles = |method: &str, level: u64| {
        let row = rows
            .iter()
            .find(|r| r["method"] == method && r["level"] == level);
        row.expect("the row")["triangles"]
            .as_u64()
            .expect("a number")
    };
    assert!(triangles("homogeneous", 2) > 2 * triangles("homogeneous", 1));
    assert_eq!(json["growth"][0]["neurons"], 4);
    assert!(
        json["ratios"]
            .as_array()
            .is_some_and(|ratios| ratios.len() >= 5)
    );
    let svg = work.text("figures/refinement.svg");
    assert!(svg.contains("3 neurons") && svg.contains("adaptive"));
    assert_eq!(work.names("figures"), ["refinement.json", "refinement.svg"]);
    work.run(&format!("{SMALL} -o figures")).exits(1);
    let table = work.run(SMALL).exits(0).stdout();
    assert!(
        table.contains("neurons: 3") && table.contains("<= 1.5"),
        "{table}"
    );
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn what_memory_does_not_allow_is_left_out_with_a_warning() {
    let work = Work::new();
    let run = work.run(&format!("{SMALL} --memory 0 --json")).exits(0);
    assert!(run.stderr().contains("left out"), "{}", run.stderr());
    let json = run.json();
    let rows = json["rows"].as_array().expect("rows");
    assert!(rows.iter().all(|row| row["method"] != "prerefined"));
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn exploration_is_timed_beside_adaptive_refinement() {
    let work = Work::new();
    let small = "bench exploration --neurons 1,6 --compare 1 --distinct 2 --points 60 --frames 1 \
                 --size 64x48 --budget 300";
    let json = work.run(&format!("{small} --json")).exits(0).json();
    let rows = json["rows"].as_array().expect("rows");
    assert_eq!(rows.len(), 2);
    for row in rows {
        let number = |key: &str| row[key].as_u64().expect("a number");
        assert!(
            number("triangles") <= 300 && number("triangles") > 0,
            "{row}"
        );
        assert!(number("wanted") >= number("triangles"), "{row}");
        assert!(
            row["exploration"]["waited"]
                .as_f64()
                .is_some_and(|ms| ms > 0.0)
        );
    }
    assert!(rows[0]["ratio"].as_f64().is_some_and(|ratio| ratio > 0.0));
    assert!(rows[1]["ratio"].is_null());
    assert!(work.run(small).exits(0).stdout().contains("wanted"));
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn static_pictures_are_colored_beside_drawn_ones() {
    let work = Work::new();
    let small =
        "bench static --neurons 2,6 --distinct 2 --points 60 --frames 2 --drawn 1 --size 96x64";
    let json = work.run(&format!("{small} --json")).exits(0).json();
    let rows = json["rows"].as_array().expect("rows");
    assert_eq!(rows.len(), 2);
    for row in rows {
        for time in ["drawn_ms", "made_ms", "recolored_ms", "ratio"] {
            assert!(row[time].as_f64().is_some_and(|ms| ms > 0.0), "{row}");
        }
        // Only what shows has a color.
        let [keys, values, weights] =
            ["keys", "values", "weights"].map(|name| row[name].as_u64().expect("a number"));
        assert!(0 < keys && keys <= values && keys <= weights, "{row}");
    }
    let table = work.run(small).exits(0).stdout();
    assert!(table.contains("recolored ms"), "{table}");
}

#[neurotess_testing::test(needs(gpu))]
fn the_second_opening_of_a_circuit_generates_nothing() {
    let work = Work::new();
    let bench = "bench opening --neurons 100 --morphologies 21 --size 48x36 --json";
    let json = work.run(bench).exits(0).json();
    let rows = json["rows"].as_array().expect("rows");
    let names: Vec<_> = rows.iter().map(|row| row["cache"].clone()).collect();
    assert_eq!(names.len(), 3);
    let meshes: Vec<_> = rows.iter().map(|row| &row["meshes"]).collect();
    assert!(meshes[0].is_null());
    assert_eq!(
        (&meshes[1]["found"], &meshes[2]["generated"]),
        (&0.into(), &0.into())
    );
    assert_eq!(meshes[1]["generated"], meshes[2]["found"]);
    assert!(
        json["cache_bytes"]
            .as_u64()
            .is_some_and(|bytes| bytes > 1 << 20)
    );
    for row in rows {
        let seconds = row["seconds"]["read"].as_f64();
        assert!(
            seconds.is_some_and(|s| s > 0.0) && row["all"].as_f64() > seconds,
            "{row}"
        );
    }
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn a_flight_past_what_does_not_fit_uploads_what_it_passes() {
    let work = Work::new();
    let small = "bench streaming --neurons 40 --points 200 --frames 8 --size 96x64 --budget 3000";
    let json = work.run(&format!("{small} --json")).exits(0).json();
    let number = |value: &serde_json::Value| value.as_u64().expect("a number");
    assert!(number(&json["memory"]) < number(&json["bytes"]), "{json}");
    let [whole, streamed] = [&json["whole"], &json["streamed"]];
    assert_eq!(
        (number(&whole["uploaded"]), &whole["finer"]),
        (0, &().into())
    );
    assert!(number(&streamed["uploaded"]) > 0, "{json}");
    for flight in [whole, streamed] {
        let [median, slowest] = ["median", "slowest"].map(|key| flight[key].as_f64());
        assert!(median > Some(0.0) && slowest >= median, "{json}");
    }
    let table = work.run(small).exits(0).stdout();
    assert!(table.contains("streamed / all there"), "{table}");
}

#[neurotess_testing::test(needs(gpu))]
fn the_adapter_tells_its_limits() {
    let work = Work::new();
    let json = work.run("bench adapter --json").exits(0).json();
    for limit in ["largest_buffer", "largest_binding", "largest_texture"] {
        assert!(json[limit].as_u64().is_some_and(|n| n > 1000), "{json}");
    }
    assert_eq!(json["software"], json["kind"] == "software");
    work.run("bench adapter --adapter none-of-this-name")
        .exits(1);
}
