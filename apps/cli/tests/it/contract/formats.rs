//! Formats of tracings that share their ending with others, and those that are not read.

use crate::work::Work;

const KNOSSOS: &str = "<things><parameters><scale x=\"10\" y=\"10\" z=\"25\"/></parameters>
<thing id=\"1\" name=\"axon\"><nodes><node id=\"1\" x=\"0\" y=\"0\" z=\"0\" radius=\"100\"/>
<node id=\"2\" x=\"0\" y=\"0\" z=\"400\" radius=\"100\"/></nodes>
<edges><edge source=\"1\" target=\"2\"/></edges></thing></things>
";

const NEUROML_1: &str = "<neuroml xmlns=\"http://morphml.org/neuroml/schema\" length_units=\"micrometer\"><cells><cell>
<segments xmlns=\"http://morphml.org/morphml/schema\"><segment id=\"2\" name=\"2\" cable=\"1\">
<proximal x=\"0\" y=\"0\" z=\"0\" diameter=\"0.4\"/><distal x=\"0\" y=\"0\" z=\"10\" diameter=\"0.4\"/></segment>
</segments></cell></cells></neuroml>
";

const TRACES: &str = "<tracings><samplespacing x=\"1\" y=\"1\" z=\"1\" units=\"micron\"/>
<path id=\"0\" swctype=\"2\"><point xd=\"0\" yd=\"0\" zd=\"0\" r=\"1\"/><point xd=\"0\" yd=\"0\" zd=\"10\" r=\"1\"/></path></tracings>
";

const NEUROLUCIDA: &str = "<mbf><tree type=\"Axon\"><point x=\"0\" y=\"0\" z=\"0\" d=\"2\"/>
<point x=\"0\" y=\"0\" z=\"10\" d=\"2\"/></tree></mbf>
";

const MOUSELIGHT: &str = "{\"neurons\": [{\"idString\": \"AA1\", \"axon\": [
{\"sampleNumber\": 1, \"structureIdentifier\": 2, \"x\": 0, \"y\": 0, \"z\": 0, \"radius\": 1, \"parentNumber\": -1},
{\"sampleNumber\": 2, \"structureIdentifier\": 6, \"x\": 0, \"y\": 0, \"z\": 10, \"radius\": 1, \"parentNumber\": 1}]}]}
";

const CATMAID: &str = "[[[1, null, 3, 0, 0, 0, 100, 5], [2, 1, 3, 0, 0, 10000, 100, 5]], [], {}]\n";

#[neurotess_testing::test]
fn the_content_tells_formats_of_one_ending_apart() {
    let work = Work::new();
    for (name, content, format) in [
        ("a.nml", KNOSSOS, "knossos"),
        ("b.nml", NEUROML_1, "neuroml"),
        ("c.traces", TRACES, "traces"),
        ("d.xml", NEUROLUCIDA, "neurolucida_xml"),
        ("e.json", MOUSELIGHT, "mouselight"),
        ("f.json", CATMAID, "catmaid"),
    ] {
        work.file(&format!("cells/{name}"), content);
        let json = work
            .run(&format!("info cells/{name} --json"))
            .exits(0)
            .json();
        assert_eq!(json[0]["format"], format, "{name}");
        let length = json[0]["length"].as_f64().expect("a number");
        assert!((length - 10.0).abs() < 1e-5, "{name}: {length}");
    }
    // Files in XML and JSON are read where they are named.
    let folder = work.run("info cells --json").exits(0).json();
    assert_eq!(folder.as_array().map(Vec::len), Some(3));
    work.run("mesh cells/e.json -o e.ply").exits(0);
    work.run("convert cells/a.nml -o a.swc").exits(0);
}

#[neurotess_testing::test]
fn what_is_not_read_is_named() {
    let work = Work::new();
    work.file("cell.hoc", "create soma\nsoma { pt3dadd(0, 0, 0, 10) }\n");
    let said = work.run("info cell.hoc").exits(1).stderr();
    assert!(
        said.contains("cell.hoc: the file is hoc, a program for NEURON"),
        "{said}"
    );
    work.file("page.nml", "<svg/>");
    let said = work.run("info page.nml").exits(1).stderr();
    assert!(
        said.contains("page.nml: the XML is <svg>, no tracing"),
        "{said}"
    );
    // Other JSON is taken for a circuit's.
    work.file("other.json", "{\"a\": 1}");
    work.run("info other.json").exits(1);
}
