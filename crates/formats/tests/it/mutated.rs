//! Files of every format in text, cut anywhere and with any byte another: they are read or refused.

use neurotess_formats::{ReadOptions, read_bytes};

const FILES: [&str; 6] = [
    "<?xml version=\"1.0\"?><neuroml id=\"x\"><cell id=\"c\"><notes>n</notes><morphology id=\"m\"><segment id=\"0\" name=\"soma\">\
     <proximal x=\"0\" y=\"0\" z=\"0\" diameter=\"9\"/><distal x=\"9\" y=\"0\" z=\"0\" diameter=\"9\"/></segment>\
     <segment id=\"1\"><parent segment=\"0\" fractionAlong=\"0.5\"/><distal x=\"9\" y=\"9\" z=\"0\" diameter=\"1\"/></segment>\
     <segmentGroup id=\"axon_group\"><path><from segment=\"1\"/><to segment=\"1\"/></path></segmentGroup>\
     </morphology></cell></neuroml>",
    "<neuroml length_units=\"micron\"><cells><cell><segments><segment id=\"1\" cable=\"1\"><proximal x=\"0\" y=\"0\" z=\"0\" \
     diameter=\"1\"/><distal x=\"9\" y=\"0\" z=\"0\" diameter=\"1\"/></segment></segments><cables><cable id=\"1\" \
     name=\"a\" fractAlongParent=\"0.5\"><group>axon_group</group></cable></cables></cell></cells></neuroml>",
    "<!DOCTYPE tracings [<!ELEMENT p (q)>]><tracings><samplespacing x=\"1\" y=\"1\" z=\"1\" units=\"micron\"/><path id=\"0\" \
     swctype=\"2\" fitted=\"2\" usefitted=\"true\"><point xd=\"0\" yd=\"0\" zd=\"0\" r=\"1\"/></path><path id=\"2\" \
     fittedversionof=\"0\"><point xd=\"0\" yd=\"0\" zd=\"0\" r=\"1\"/><point xd=\"9\" yd=\"0\" zd=\"0\"/></path><path \
     id=\"1\" startson=\"0\" startsx=\"9\" startsy=\"0\" startsz=\"0\"><point x=\"9\" y=\"0\" z=\"0\"/></path></tracings>",
    "<things><parameters><scale x=\"1\" y=\"1\" z=\"2\" unit=\"nm\"/></parameters><thing id=\"1\" name=\"axon\"><nodes>\
     <node id=\"1\" x=\"0\" y=\"0\" z=\"0\" radius=\"1\"/><node id=\"2\" x=\"9\" y=\"0\" z=\"0\"/></nodes><edges>\
     <edge source=\"1\" target=\"2\"/></edges></thing><comments><comment node=\"1\" content=\"soma\"/></comments></things>",
    "<mbf><contour name=\"CellBody\"><point x=\"0\" y=\"0\" z=\"0\" d=\"1\"/></contour><tree type=\"Axon\"><point x=\"0\" \
     y=\"0\" z=\"0\" d=\"1\"/><branch><point x=\"9\" y=\"0\" z=\"0\" d=\"1\"/><spine><point x=\"9\" y=\"1\" z=\"0\" d=\"1\"/>\
     </spine></branch></tree></mbf>",
    "{\"neurons\": [{\"idString\": \"A\", \"soma\": {\"x\": 0, \"y\": 0, \"z\": 0}, \"axon\": [{\"sampleNumber\": 1, \
     \"structureIdentifier\": 1, \"x\": 0, \"y\": 0, \"z\": 0, \"radius\": 1, \"parentNumber\": -1}, {\"sampleNumber\": 2, \
     \"x\": 9, \"y\": 0, \"z\": 0, \"parentNumber\": 1}]}]}",
];

#[neurotess_testing::test]
fn cut_and_changed_files_never_panic() {
    let options = ReadOptions::default();
    for file in FILES {
        let bytes = file.as_bytes();
        read_bytes(bytes.to_vec(), "whole", None, &options).expect(file);
        for at in 0..bytes.len() {
            let _ = read_bytes(bytes[..at].to_vec(), "cut", None, &options);
            for other in *b"<>\"'/&-9x \0\xff" {
                let mut changed = bytes.to_vec();
                changed[at] = other;
                let _ = read_bytes(changed, "changed", None, &options);
            }
        }
    }
}
