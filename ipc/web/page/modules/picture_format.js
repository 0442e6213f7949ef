// A picture as it comes over the WebSocket: 32 bytes, little-endian, then a JPEG file (docs/monitor-page.md).

export const kHeaderBytes = 32;

// {sequence, width, height, age_s, jpeg: Uint8Array}, or null where it is not a picture.
export function decode_picture(buffer) {
  if (!(buffer instanceof ArrayBuffer) || buffer.byteLength <= kHeaderBytes) return null;
  const view = new DataView(buffer);
  if (view.getUint32(0, true) !== 0x31504d43) return null;  // "CMP1"
  const picture = {
    sequence: view.getUint32(4, true),
    width: view.getUint16(8, true),
    height: view.getUint16(10, true),
    age_s: view.getFloat64(16, true),
    jpeg: new Uint8Array(buffer, kHeaderBytes),
  };
  return picture.width > 0 && picture.height > 0 ? picture : null;
}
