import { Mesher, Progress } from "./mesher.js";
export { Mesher, MeshError, Mesh, Settings, Progress } from "./mesher.js";
/** Starts the mesher with the ptriangle.wasm beside this file. */
export function load(progress?: Progress): Promise<Mesher>;
