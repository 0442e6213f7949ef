// Deforming surfaces as they come over the WebSocket (docs/monitor-page.md): little-endian, each part at a multiple of 4 bytes. A
// shape holds what stays while nothing is cut or clipped, a motion where it is now. Pure.

const kShape = 0x31544d43;   // "CMT1"
const kMotion = 0x314d4d43;  // "CMM1"

const begins_with = (buffer, magic, bytes) =>
  buffer instanceof ArrayBuffer && buffer.byteLength >= bytes && new DataView(buffer).getUint32(0, true) === magic;
export const is_tissue_shape = (buffer) => begins_with(buffer, kShape, 16);
export const is_tissue_motion = (buffer) => begins_with(buffer, kMotion, 24);

// Reads arrays one behind the other; throws RangeError where the message is cut.
class Reader {
  constructor(buffer, at) {
    this.buffer_ = buffer;
    this.at_ = at;
  }

  take(Kind, count) {
    const out = new Kind(this.buffer_, this.at_, count);
    this.at_ += 4 * Math.ceil(out.byteLength / 4);
    return out;
  }

  number() {
    return this.take(Uint32Array, 1)[0];
  }
}

function read(test, head, read_rest) {
  return (buffer) => {
    if (!test(buffer)) return null;
    try {
      const reader = new Reader(buffer, 4);
      return read_rest(Object.fromEntries(head.map((name) => [name, reader.number()])), reader);
    } catch (error) {
      if (error instanceof RangeError) return null;
      throw error;
    }
  };
}

const times = (count, make) => Array.from({length: Math.min(count, 4096)}, make);

// {number, surfaces: [{vertices, skin, corners, colours}], clips: [{points, corners}]}; null where it is something else or cut.
// `skin`: how many of the triangles are not faces of cuts.
export const decode_tissue_shape = read(is_tissue_shape, ["number", "surfaces", "clips"], ({number, surfaces, clips}, reader) => ({
  number,
  surfaces: times(surfaces, () => {
    const [vertices, triangles, skin] = reader.take(Uint32Array, 3);
    return {vertices, skin, corners: reader.take(Uint32Array, 3 * triangles), colours: reader.take(Uint8Array, 4 * vertices)};
  }),
  clips: times(clips, () => {
    const [points, triangles] = reader.take(Uint32Array, 2);
    return {points: reader.take(Float32Array, 3 * points), corners: reader.take(Uint32Array, 3 * triangles)};
  }),
}));

// {number, surfaces: [{low, edges, shown, wet, places, normals, burns}], clips: Float32Array of poses, particles, pool}; null as above.
// `vertices`: of each surface, from the shape with that number.
export function decode_tissue_motion(buffer, vertices) {
  return read(is_tissue_motion, ["number", "surfaces", "clips", "particles", "pools"], (head, reader) => {
    if (head.surfaces !== vertices.length || head.pools > 1) return null;
    const surfaces = vertices.map((count) => {
      const box = reader.take(Float32Array, 6);
      const bits = reader.number();
      return {low: box.subarray(0, 3), edges: box.subarray(3), shown: (bits & 1) !== 0, wet: (bits & 2) !== 0,
        places: reader.take(Uint16Array, 3 * count), normals: reader.take(Int8Array, 2 * count), burns: reader.take(Uint8Array, count)};
    });
    const clips = reader.take(Float32Array, 7 * head.clips);
    const particles = times(head.particles, () => {
      const [x, y, z, radius] = reader.take(Float32Array, 4);
      return {at: [x, y, z], radius, kind: reader.number()};
    });
    const pool = head.pools === 1 ? {pose: reader.take(Float32Array, 7), size: reader.take(Float32Array, 3), colour: reader.number()} : null;
    return {number: head.number, surfaces, clips, particles, pool};
  })(buffer);
}

// Places of vertices in m.
export function unpack_places(surface, into) {
  const {low, edges, places} = surface;
  const scale = [edges[0] / 65535, edges[1] / 65535, edges[2] / 65535];
  for (let i = 0; i < places.length; i += 3) {
    into[i] = low[0] + scale[0] * places[i];
    into[i + 1] = low[1] + scale[1] * places[i + 1];
    into[i + 2] = low[2] + scale[2] * places[i + 2];
  }
}

// Octahedral normals as unit vectors.
export function unpack_normals(normals, into) {
  for (let i = 0, k = 0; i < normals.length; i += 2, k += 3) {
    let x = normals[i] / 127;
    let y = normals[i + 1] / 127;
    const z = 1 - Math.abs(x) - Math.abs(y);
    const fold = Math.max(0, -z);
    x += x >= 0 ? -fold : fold;
    y += y >= 0 ? -fold : fold;
    const length = Math.hypot(x, y, z) || 1;
    into[k] = x / length;
    into[k + 1] = y / length;
    into[k + 2] = z / length;
  }
}

// The colour of a vertex after burning, as in the gateway's pictures: brown where it is coagulated, then black. 0 to 1.
const kCoagulated = [0.36, 0.22, 0.12];
const kCharred = [0.05, 0.045, 0.04];
export function unpack_colours(colours, burns, into) {
  for (let i = 0; i < burns.length; ++i) {
    const burn = burns[i] / 127.5;
    const brown = 0.85 * Math.min(1, burn);
    const black = 0.96 * Math.max(0, burn - 1);
    for (let k = 0; k < 3; ++k) {
      const own = colours[4 * i + k] / 255;
      const coagulated = own + brown * (kCoagulated[k] - own);
      into[3 * i + k] = coagulated + black * (kCharred[k] - coagulated);
    }
  }
}
