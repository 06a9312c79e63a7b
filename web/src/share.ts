// Output of the page: links, zip files, downloads.
async function through(bytes: Uint8Array, stream: CompressionStream | DecompressionStream): Promise<Uint8Array> {
  return new Uint8Array(await new Response(new Blob([bytes as BlobPart]).stream().pipeThrough(stream)).arrayBuffer());
}

/** Encode text as characters that are valid in a link, and decode it. */
export async function pack(text: string): Promise<string> {
  const bytes = await through(new TextEncoder().encode(text), new CompressionStream("deflate-raw"));
  let binary = "";
  for (let i = 0; i < bytes.length; i += 8192) binary += String.fromCharCode(...bytes.subarray(i, i + 8192));
  return btoa(binary).replace(/\+/g, "-").replace(/\//g, "_").replace(/=+$/, "");
}
export const bytesOf = (base64: string) => Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
export const unzip = (bytes: Uint8Array) => through(bytes, new DecompressionStream("gzip"));
export async function unpack(letters: string): Promise<string> {
  const bytes = bytesOf(letters.replace(/-/g, "+").replace(/_/g, "/"));
  return new TextDecoder().decode(await through(bytes, new DecompressionStream("deflate-raw")));
}

const table = Uint32Array.from({ length: 256 }, (_, n) => {
  for (let k = 0; k < 8; k++) n = n & 1 ? 0xedb88320 ^ (n >>> 1) : n >>> 1;
  return n;
});
function crc(bytes: Uint8Array): number {
  let c = 0xffffffff;
  for (const b of bytes) c = table[(c ^ b) & 255]! ^ (c >>> 8);
  return ~c >>> 0;
}

/** Makes a zip file without compression. */
export function zip(files: [string, Uint8Array][]): Uint8Array {
  const parts: Uint8Array[] = [], directory: Uint8Array[] = [];
  let at = 0;
  const record = (size: number, values: [number, number, number][], name = "") => {
    const letters = new TextEncoder().encode(name), bytes = new Uint8Array(size + letters.length);
    const view = new DataView(bytes.buffer);
    for (const [place, width, v] of values) width === 2 ? view.setUint16(place, v, true) : view.setUint32(place, v,
      true);
    bytes.set(letters, size);
    return bytes;
  };
  for (const [name, bytes] of files) {
    const sum = crc(bytes), n = bytes.length, day = 0x5821, long = new TextEncoder().encode(name).length;
    const head = record(30, [[0, 4, 0x04034b50], [4, 2, 20], [6, 2, 0x800], [12, 2, day], [14, 4, sum], [18, 4, n],
      [22, 4, n], [26, 2, long]], name); // 0x800: names are UTF-8
    directory.push(record(46, [[0, 4, 0x02014b50], [4, 2, 20], [6, 2, 20], [8, 2, 0x800], [14, 2, day], [16, 4, sum],
      [20, 4, n], [24, 4, n], [28, 2, long], [42, 4, at]], name));
    parts.push(head, bytes);
    at += head.length + n;
  }
  const size = directory.reduce((s, d) => s + d.length, 0);
  parts.push(...directory, record(22, [[0, 4, 0x06054b50], [8, 2, files.length], [10, 2, files.length], [12, 4, size],
    [16, 4, at]]));
  const whole = new Uint8Array(parts.reduce((s, p) => s + p.length, 0));
  let place = 0;
  for (const p of parts) { whole.set(p, place); place += p.length; }
  return whole;
}

export function save(name: string, content: Blob | Uint8Array | string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(content instanceof Blob ? content : new Blob([content as BlobPart]));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}
