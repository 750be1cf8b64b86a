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

/** A picture by a table: colours[i], where the bits of i are the tones of the layers, the first one highest. */
export function tabled(width, height, layers, colours) {
    const image = new ImageData(width, height), out = new Uint32Array(image.data.buffer), table = colours.map(opaque);
    for (let i = 0; i < out.length; i++) {
        let row = 0;
        for (const layer of layers) row = (row << 1) | (layer[i] >> 7);
        out[i] = table[row];
    }
    return canvasOf(width, height, image);
}

/** Two pictures of one size, one over the other by a canvas's operation. */
export function combined(a, b, operation) {
    const canvas = new OffscreenCanvas(a.width, a.height), context = canvas.getContext("2d");
    context.drawImage(a, 0, 0);
    context.globalCompositeOperation = operation;
    context.drawImage(b, 0, 0);
    return canvas;
}

/** As bytesOf, what is white made so many pixels wider to each side: fine lines are seen from afar. */
export function marksOf(bitmap, width, height, reach) {
    const canvas = new OffscreenCanvas(width, height), context = canvas.getContext("2d");
    context.globalCompositeOperation = "lighten";
    context.imageSmoothingEnabled = reach === 0;
    for (let y = -reach; y <= reach; y++) for (let x = -reach; x <= reach; x++) context.drawImage(bitmap, x, y, width, height);
    return bytesOf(canvas, width, height);
}

/** A picture that has its colours already, as bytesOf gave them. */
export const given = (width, height, data) => canvasOf(width, height, new ImageData(data, width, height));
