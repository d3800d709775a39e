// What the page holds beside its modules: JSON, and packed bytes.

/** As the page unpacks its modules; see markup/unpack.js. */
export const bytesOf = globalThis.unpack;

/** @returns {Promise<*>} what an element's bytes say as JSON */
export async function jsonOf(name) {
  return JSON.parse(new TextDecoder().decode(await bytesOf(name)));
}

/** Let the user keep a file. */
export function download(content, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([content]));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

/**
 * Take the files that the user picks, one after the other.
 * @param {HTMLInputElement} input
 * @param {(file: File) => void} take
 */
export function picks(input, take) {
  input.onchange = () => {
    const [file] = input.files;
    input.value = ""; // so that the same file, changed meanwhile, can be picked again
    if (file) take(file);
  };
}

/** @returns {string} the time, for names of files: 2026-11-27_09-05-00 */
export function timeStamp() {
  const now = new Date();
  const local = new Date(now.getTime() - now.getTimezoneOffset() * 60_000);
  return local.toISOString().slice(0, 19).replace("T", "_").replaceAll(":", "-");
}

/**
 * Make an element.
 * @param {string} tag
 * @param {object} properties
 * @param {...(Node | string)} children
 */
export function make(tag, properties = {}, ...children) {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
}
