// Building elements without markup strings.

/** An element with attributes, listeners (on...) and children; false and null children are left out. */
export function make(tag, attributes = {}, ...children) {
    const node = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) {
        if (name.startsWith("on")) node.addEventListener(name.slice(2), value);
        else if (value === true) node.setAttribute(name, "");
        else if (value !== false && value != null) node.setAttribute(name, value);
    }
    node.append(...children.flat(Infinity).filter((child) => child !== null && child !== false));
    return node;
}

let count = 0;
export const freshId = (name) => `${name}-${++count}`;
