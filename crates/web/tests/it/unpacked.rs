//! What is in a page, read as the page itself reads it.

use std::io::Read;

use flate2::read::DeflateDecoder;
use serde_json::Value;

/// One of the two packed texts of a page: its JSON and the bytes behind it.
pub(crate) struct Unpacked {
    pub(crate) json: Value,
    pub(crate) bytes: Vec<u8>,
}

const SIGNS: &str =
    "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz!#$%()*+,-./:;=?@[]^_|~";

impl Unpacked {
    /// The text with this id.
    pub(crate) fn of(html: &str, id: &str) -> Self {
        let begin = format!("id=\"{id}\">");
        let (_, text) = html.split_once(&begin).expect("it is there");
        let (text, _) = text.split_once('<').expect("it ends");
        let packed = base85(text);
        let length = u32::from_be_bytes(packed[..4].try_into().expect("four")) as usize;
        let mut all = Vec::new();
        let mut decoder = DeflateDecoder::new(&packed[4..4 + length]);
        decoder.read_to_end(&mut all).expect("deflated");
        let json = u32::from_le_bytes(all[..4].try_into().expect("four")) as usize;
        Self {
            json: serde_json::from_slice(&all[4..4 + json]).expect("JSON"),
            bytes: all[4 + json..].to_vec(),
        }
    }

    /// The records of an array.
    pub(crate) fn records(&self, of: &Value) -> Vec<u32> {
        let number = |value: &Value| value.as_u64().expect("a number") as usize;
        let mut read = number(&of["at"]);
        let mut made = Vec::new();
        for stretch in of["records"].as_array().expect("records") {
            let (count, size) = (number(&stretch[0]), number(&stretch[1]));
            let mut records = vec![0_u8; 4 * size * count];
            for byte in 0..4 * size {
                let mut value = 0_u8;
                for k in 0..count {
                    value = value.wrapping_add(self.bytes[read]);
                    records[4 * size * k + byte] = value;
                    read += 1;
                }
            }
            let numbers = records.chunks_exact(4);
            made.extend(numbers.map(|b| u32::from_le_bytes(b.try_into().expect("four"))));
        }
        made
    }
}

fn base85(text: &str) -> Vec<u8> {
    let value = |sign: u8| {
        SIGNS
            .bytes()
            .position(|known| known == sign)
            .expect("a sign") as u64
    };
    let five = text.as_bytes().chunks_exact(5);
    let number = |five: &[u8]| {
        five.iter()
            .fold(0, |number, &sign| 85 * number + value(sign))
    };
    five.flat_map(|five| (number(five) as u32).to_be_bytes())
        .collect()
}

/// Bytes of what `btoa` writes.
pub(crate) fn base64(text: &str) -> Vec<u8> {
    let signs = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let value = |sign: u8| signs.bytes().position(|known| known == sign).unwrap_or(0) as u32;
    let mut bytes: Vec<u8> = text
        .as_bytes()
        .chunks_exact(4)
        .flat_map(|four| {
            let bits = four.iter().fold(0, |bits, &sign| (bits << 6) | value(sign));
            [(bits >> 16) as u8, (bits >> 8) as u8, bits as u8]
        })
        .collect();
    bytes.truncate(bytes.len() - text.bytes().rev().take_while(|&sign| sign == b'=').count());
    bytes
}
