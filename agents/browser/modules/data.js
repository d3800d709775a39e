// What the page holds beside its modules: JSON, and packed bytes.

import { fromBase64 } from "arkanoid/game";

/**
 * @param {string} name of an element of the page
 * @returns {Promise<Uint8Array>} the bytes that it holds: zlib's, as base64
 */
export async function bytesOf(name) {
  const packed = fromBase64(document.getElementById(`data-${name}`).textContent);
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

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
