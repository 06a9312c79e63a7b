// For node and bundlers: finds ptriangle.wasm beside this file.
import { Mesher } from "./mesher.js";
export { Mesher, MeshError } from "./mesher.js";

export async function load(progress) {
  const place = new URL("./ptriangle.wasm", import.meta.url);
  if (place.protocol !== "file:") return Mesher.load(await (await fetch(place)).arrayBuffer(), progress);
  const { readFile } = await import("node:fs/promises");
  return Mesher.load(await readFile(place), progress);
}
