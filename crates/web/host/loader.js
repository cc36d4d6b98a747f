// Unpacks the host and the cells of the page and starts the host. See page.rs.
const unpacked = async (text) => {
  const values = new Uint8Array(128);
  [...'{signs}'].forEach((sign, k) => { values[sign.charCodeAt(0)] = k; });
  const bytes = new Uint8Array(text.length / 5 * 4), view = new DataView(bytes.buffer);
  for (let k = 0; k < text.length; k += 5) {
    let number = 0;
    for (let sign = 0; sign < 5; sign++) number = 85 * number + values[text.charCodeAt(k + sign)];
    view.setUint32(k / 5 * 4, number);
  }
  const stream = new Blob([bytes.subarray(4, 4 + view.getUint32(0))]).stream().pipeThrough(new DecompressionStream('deflate-raw'));
  const all = await new Response(stream).arrayBuffer();
  const length = new DataView(all).getUint32(0, true);
  return [JSON.parse(new TextDecoder().decode(new Uint8Array(all, 4, length))), all, 4 + length];
};
(async () => {
  try {
    const packed = (id) => unpacked(document.getElementById(id).textContent);
    const [shaders, host, start] = await packed('host');
    const [cells, bytes, first] = await packed('cells');
    const style = document.createElement('style');
    style.textContent = shaders.style;
    document.head.append(style);
    // Joined: in a replacement, $ and what follows it would stand for parts of the page.
    document.body.innerHTML = shaders.body.split('{name}').join(document.querySelector('title').innerHTML.replaceAll('"', '&quot;'));
    window.neurotess = { shaders, cells, bytes, first, unpacked };
    const script = document.createElement('script');
    script.type = 'module';
    script.textContent = new TextDecoder().decode(new Uint8Array(host, start));
    document.head.append(script);
  } catch (error) {
    document.body.textContent = `This page cannot be shown: ${error.message}. Use a newer browser.`;
  }
})();
