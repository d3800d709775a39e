// Unpacks what the page holds, see packing.py, and begins with its modules.

/**
 * @param {string} name of an element of the page
 * @returns {Promise<Uint8Array>} the bytes that it holds
 */
async function unpack(name) {
  const { textContent, dataset } = document.getElementById(`data-${name}`);
  const stream = new Blob([bytesOf(textContent)]).stream();
  const inflated = new Response(stream.pipeThrough(new DecompressionStream("deflate")));
  return joinPlanes(new Uint8Array(await inflated.arrayBuffer()), Number(dataset.width));
}

/** @returns {Uint8Array} what letters hold, each 7 bits */
function bytesOf(text) {
  const bytes = new Uint8Array((7 * text.length) >> 3);
  let held = 0; // the lowest bits of it are still to be written: so many
  let bits = 0;
  let length = 0;
  for (let place = 0; place < text.length; place += 1) {
    held = (held << 7) | (text.charCodeAt(place) & 127);
    bits += 7;
    if (bits < 8) continue;
    bits -= 8;
    bytes[length] = held >> bits;
    length += 1;
  }
  return bytes;
}

/** @returns {Uint8Array} numbers, of which all first bytes are given, then all second ones ... */
function joinPlanes(planes, width) {
  const bytes = new Uint8Array(planes.length);
  let from = 0;
  for (let first = 0; first < width; first += 1) {
    for (let to = first; to < bytes.length; to += width, from += 1) bytes[to] = planes[from];
  }
  return bytes;
}

/** Give the modules addresses, so that they can import each other by their names; run the first. */
async function begin() {
  if (!document.getElementById("end")) throw new Error("the page has no end");
  const modules = JSON.parse(new TextDecoder().decode(await unpack("modules")));
  const imports = {};
  for (const [name, code] of Object.entries(modules)) {
    imports[name] = URL.createObjectURL(new Blob([code], { type: "text/javascript" }));
  }
  const map = document.createElement("script");
  map.type = "importmap";
  map.textContent = JSON.stringify({ imports });
  document.head.append(map);
  await import("arkanoid/app");
}

addEventListener("DOMContentLoaded", async () => {
  const notice = document.getElementById("notice");
  if (!HTMLScriptElement.supports?.("importmap")) {
    notice.textContent = "This game needs a browser of 2023 or later.";
    return;
  }
  try {
    await begin();
  } catch (error) {
    notice.textContent =
      "The game does not start. The page is not complete, or its site forbids WebAssembly.";
    throw error;
  }
});
