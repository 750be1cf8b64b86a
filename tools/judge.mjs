// What manifold-3d says of a binary STL: is it a manifold, in one piece, of which volume and genus?
//
//     node judge.mjs FILE.stl
import { readFileSync } from 'node:fs'
import init from 'manifold-3d'

const bytes = readFileSync(process.argv[2])
const triangles = bytes.readUInt32LE(80)
const numbers = new Map(), vertices = [], corners = new Uint32Array(3 * triangles)
for (let i = 0; i < 3 * triangles; i++) {
    const at = 84 + 50 * Math.floor(i / 3) + 12 + 12 * (i % 3)
    const key = bytes.toString('latin1', at, at + 12)
    let number = numbers.get(key)
    if (number === undefined) {
        number = numbers.size
        numbers.set(key, number)
        for (let k = 0; k < 3; k++) vertices.push(bytes.readFloatLE(at + 4 * k))
    }
    corners[i] = number
}
const module = await init()
module.setup()
const { Manifold, Mesh } = module
let solid
try {
    solid = new Manifold(new Mesh({ numProp: 3, vertProperties: new Float32Array(vertices), triVerts: corners }))
} catch (error) {
    console.log(`refused: ${error.message ?? error}`)
    process.exit(1)
}
const parts = solid.decompose().length
console.log(`status ${solid.status()}\nparts ${parts}\nvolume ${solid.volume()}\ngenus ${solid.genus()}`)
process.exit(parts === 1 && solid.numTri() > 0 ? 0 : 1)
