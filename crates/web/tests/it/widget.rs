//! The widget in a browser: what joins a page in a frame with the kernel, of which there is a model only.

use std::fs;

use neurotess_testing::full;
use neurotess_web::widget_script;
use serde_json::{Value, json};

use crate::browser::{Browser, chromium};
use crate::written::{Meshed, page_of};

/// The model of a widget, as anywidget hands it over.
const MODEL: &str = "
class Model {
  constructor(state) { Object.assign(this, { state, heard: new Map(), sent: [] }); }
  get(name) { return this.state[name]; }
  set(name, value) {
    if (JSON.stringify(this.state[name]) === JSON.stringify(value)) return;
    this.state[name] = value;
    for (const act of this.heard.get(`change:${name}`) ?? []) act();
  }
  save_changes() {}
  send(message) { this.sent.push(message); }
  on(event, act) { this.heard.set(event, [...(this.heard.get(event) ?? []), act]); }
  off(event, act) { this.heard.set(event, (this.heard.get(event) ?? []).filter((other) => other !== act)); }
}
window.model = new Model({ _key: 'k', _camera: null, color_by: 'type', hidden: [], orthographic: false, time: null });
const until = async (is) => { while (!is()) await new Promise((resolve) => setTimeout(resolve, 20)); };
window.frame = document.querySelector('iframe');
window.joined = async () => {
  await until(() => frame.contentWindow.neurotess?.app?.shown !== undefined && model.get('_camera'));
  await new Promise((resolve) => setTimeout(resolve, 100));
  window.app = frame.contentWindow.neurotess.app;
  await app.loop.settled();
};
const end = widget.initialize({ model });
window.part = end;
window.neurotess = { ready: joined() };
";

/// Pages draw with WebGL here, which opens faster in software.
const NO_WEBGPU: &str =
    "<script>Object.defineProperty(Navigator.prototype,'gpu',{value:undefined})</script>";

fn opened(folder: &tempfile::TempDir) -> Browser {
    let (_, page) = page_of(Meshed::sample("granule"));
    let page = page.html.replace("<title>", &format!("{NO_WEBGPU}<title>"));
    let page = page.replace('&', "&amp;").replace('"', "&quot;");
    let widget = widget_script().replace("export default", "const widget=");
    let notebook = format!(
        "<!doctype html><body><iframe data-view=\"k\" style=\"width:320px;height:240px;border:0\" \
         srcdoc=\"{page}\"></iframe><script type=\"module\">{widget}{MODEL}</script>"
    );
    let file = folder.path().join("notebook.html");
    fs::write(&file, notebook).expect("written");
    Browser::open(folder.path(), &file, "", [400, 300])
}

/// Numbers of a nested array, flat.
fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(all) => all.iter().flat_map(numbers).collect(),
        one => vec![one.as_f64().expect("a number")],
    }
}

fn assert_near(a: &Value, b: &Value) {
    let [a, b] = [a, b].map(numbers);
    let near = a.len() == b.len() && a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-6);
    assert!(near, "{a:?} {b:?}");
}

const CAMERA: &str = "[app.camera.eye(), app.camera.target, app.camera.axes().up, \
                      2 * Math.atan(app.camera.tan)]";

#[neurotess_testing::test(needs(full, chromium))]
fn pages_in_notebooks_and_their_views_are_kept_equal() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut browser = opened(&folder);
    // What the page shows is told.
    let shown = browser.evaluate(CAMERA);
    assert_near(&browser.evaluate("model.get('_camera')"), &shown);
    // What the view is set to shows.
    let pressed = "Array.from(frame.contentDocument.querySelectorAll('#legend button'), \
                   (b) => [b.textContent, b.getAttribute('aria-pressed')])";
    browser.evaluate("model.set('hidden', ['axon'])");
    let legend = browser.evaluate(pressed);
    let legend = legend.as_array().expect("entries");
    assert!(legend.contains(&json!(["axon", "false"])), "{legend:?}");
    assert!(legend.contains(&json!(["soma", "true"])), "{legend:?}");
    browser.evaluate("model.set('orthographic', true); model.set('color_by', 'depth')");
    assert_eq!(
        browser.evaluate("[app.colors.scheme.id, app.checked('orthographic')]"),
        json!(["distance", true])
    );
    // A camera that leans, and one from above.
    for seen in [
        json!([[30, 40, 120], [0, 10, 0], [0.8, 0, -0.2], 0.5]),
        json!([[0, 500, 0.5], [0, 0, 0.5], [0, 0, -1], 0.3]),
    ] {
        browser.evaluate(&format!("model.set('_camera', {seen}); app.loop.settled()"));
        let shown = browser.evaluate(CAMERA);
        let [eye, target, up, fov] = [0, 1, 2, 3].map(|k| &shown[k]);
        assert_near(target, &seen[1]);
        assert_near(fov, &seen[3]);
        // Right above, the eye is a ten thousandth beside.
        let beside: Vec<f64> = numbers(eye)
            .iter()
            .zip(numbers(&seen[0]))
            .map(|(a, b)| a - b)
            .collect();
        assert!(beside.iter().all(|d| d.abs() < 0.06), "{eye} {seen}");
        let along: f64 = numbers(up)
            .iter()
            .zip(numbers(&seen[2]))
            .map(|(a, b)| a * b)
            .sum();
        assert!(along > 0.5, "{up} {seen}");
        // The view has it as it is.
        assert_near(&browser.evaluate("model.get('_camera')"), &shown);
    }
    // What readers change is told at rest, of each color with what it hides.
    browser.evaluate(
        "(async () => {
           const scheme = frame.contentDocument.getElementById('scheme');
           scheme.value = 'type';
           scheme.dispatchEvent(new Event('input'));
           app.act('f');
           await app.loop.settled();
         })()",
    );
    let told = browser.evaluate("[model.get('color_by'), model.get('hidden')]");
    assert_eq!(told, json!(["type", ["axon"]]));
    let shown = browser.evaluate(CAMERA);
    assert_near(&browser.evaluate("model.get('_camera')"), &shown);
    let up = numbers(&shown[2]);
    assert!(up[0].abs() < 1e-6 && up[2] < -0.99, "{up:?}");
    // Clicks are told with what they are on.
    browser.evaluate(
        "(async () => {
           model.set('hidden', []);
           const soma = app.scene.section.findIndex((section) => section === 0xffff);
           window.at = app.camera.project(app.scene.place(soma).center, 320, 240);
           await app.click(...at);
           await app.click(1, 1);
         })()",
    );
    let sent = browser.evaluate("model.sent");
    let key = &sent[0]["picked"]["key"];
    let there = browser.evaluate("app.pick(...at).then((place) => place.key)");
    assert_eq!(key, &there);
    assert_near(
        &sent[0]["picked"]["position"],
        &browser.evaluate(&format!("app.scene.place({key}).center")),
    );
    assert_eq!(sent[1], json!({"picked": null}));
    assert_eq!(browser.evaluate("model.sent.length"), json!(2));
    // An output that is taken away and put back shows what it showed.
    browser.evaluate(
        "(async () => {
           model.set('hidden', ['axon']);
           const parent = frame.parentElement;
           frame.remove();
           parent.append(frame);
           await joined();
         })()",
    );
    assert_near(&browser.evaluate(CAMERA), &shown);
    let legend = browser.evaluate(pressed);
    let legend = legend.as_array().expect("entries");
    assert!(legend.contains(&json!(["axon", "false"])), "{legend:?}");
    // Without the widget the page stays what it is.
    browser.evaluate("part(); model.set('hidden', []); app.loop.settled()");
    let hidden = browser.evaluate("[...app.colors.hiddenNow()].length");
    assert_eq!(hidden, json!(1));
    assert!(browser.said.is_empty(), "{:?}", browser.said);
}
