// Colouring pictures of black and white, quickly: a preview passes here within its few ms.

const opaque = ([r, g, b]) => ((255 << 24) | (b << 16) | (g << 8) | r) >>> 0;

/** One byte a pixel, 0 or 255 and what scaling makes of it, of an ImageBitmap at another size; three with `coloured`. */
export function bytesOf(bitmap, width, height, coloured = false) {
    const canvas = new OffscreenCanvas(width, height), context = canvas.getContext("2d", { willReadFrequently: true });
    context.imageSmoothingEnabled = bitmap.width > width;
    context.drawImage(bitmap, 0, 0, width, height);
    const { data } = context.getImageData(0, 0, width, height);
    if (coloured) return data;
    const out = new Uint8Array(width * height);
    for (let i = 0, p = 0; i < out.length; i++, p += 4) out[i] = data[p];
    return out;
}

function canvasOf(width, height, image) {
    const canvas = new OffscreenCanvas(width, height);
    canvas.getContext("2d").putImageData(image, 0, 0);
    return canvas;
}

/** A picture in two colours. */
export function plain(width, height, bytes, dark, light) {
    const image = new ImageData(width, height), out = new Uint32Array(image.data.buffer), colour = [opaque(dark), opaque(light)];
    for (let i = 0; i < out.length; i++) out[i] = colour[bytes[i] >> 7];
    return canvasOf(width, height, image);
}

/** What two pictures have in common in the two colours, what was made solid in `added`, what was opened in `opened`. */
export function changed(width, height, was, is, dark, light, added, opened) {
    const image = new ImageData(width, height), out = new Uint32Array(image.data.buffer);
    const colour = [opaque(dark), opaque(added), opaque(opened), opaque(light)]; // by was * 2 + is
    for (let i = 0; i < out.length; i++) out[i] = colour[((was[i] >> 7) << 1) | (is[i] >> 7)];
    return canvasOf(width, height, image);
}

/** A picture that has its colours already, as bytesOf gave them. */
export const given = (width, height, data) => canvasOf(width, height, new ImageData(data, width, height));
