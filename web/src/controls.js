// The form: what of the picture, how large, by which printer, on what, and what it bears.

import { make } from "./dom.js";
import { check, forget, group, menu, note, onUpdate, picker, slider, updateFields } from "./fields.js";
import { MODELS, PICTURES, PROFILES, sampleUrl } from "./files.js";
import { thresholdField } from "./levels.js";
import { placingOf } from "./placing.js";
import { vectorField } from "./placing-fields.js";
import { MOST_COPIES, canGoAround, change, copiesAround, goesAround, profileOf, state } from "./state.js";
import { text } from "./strings.js";

function thumbnail(name) {
    const image = make("img", { alt: "", width: 44, height: 44 });
    sampleUrl(name).then((url) => { image.src = url; }, () => {}); // the name is there all the same
    return image;
}

// Where a long name may break: not every browser has a dictionary.
const hyphenated = (name) => name.replace(/(?<=sun)flower|(?<=checker)board/, "\u00ad$&");

function gallery(lists) {
    const root = make("div", { class: "gallery", role: "group", "aria-label": text("samples") },
        lists.samples.map(({ name, what }) => make("button", { type: "button", title: what, "data-sample": name,
            onclick: () => change({ sample: name, upload: "", uploadName: "", crop: "", edits: "" }) }, thumbnail(name), hyphenated(name))));
    onUpdate((s) => {
        for (const button of root.children) button.setAttribute("aria-pressed", String(button.dataset.sample === s.sample));
    });
    return root;
}

// Turning also turns what is cropped: the crop counts the picture's own pixels.
function shapeRow(openCrop) {
    const tool = (words, id, onclick) => make("button", { type: "button", class: "tool", id, onclick }, text(words));
    const mirror = tool("mirror", "mirror", () => change({ mirror: !state().mirror }));
    const crop = tool("crop", "crop", openCrop);
    onUpdate((s) => {
        mirror.setAttribute("aria-pressed", String(s.mirror));
        crop.setAttribute("aria-pressed", String(s.crop !== ""));
    });
    return make("div", { class: "tool-row" }, crop, tool("rotate", "rotate", () => change({ rotate: (state().rotate + 90) % 360 })), mirror);
}

const pictureGroup = (lists, take, openCrop) => group("picture",
    picker("choose", `${PICTURES},.jali`, take, true), make("p", { class: "hint" }, text("orDrop")), gallery(lists),
    shapeRow(openCrop), thresholdField(), check("invert", "invert"));

// The printers by process, then one's own.
function printerChoices(lists) {
    const kinds = new Map();
    for (const p of lists.printers) {
        const kind = p.own ? text("ownPrinters") : text(`process_${p.process || "none"}`);
        if (!kinds.has(kind)) kinds.set(kind, []);
        kinds.get(kind).push([p.name, p.name]);
    }
    return [...kinds, [text("ownPrinters"), [["file", text("ownFile")], ["", text("ownPrinter")]]]];
}

const round = (value) => Number(value.toFixed(3));

// What the chosen printer is, in words and in its three figures.
function printerWords(s, lists) {
    if (s.printer === "") return "";
    if (s.printer === "file" && !profileOf(s)) return text("noProfile");
    const profile = s.printer === "file" ? profileOf(s) : null, value = (key) => profile[key].value ?? profile[key];
    const p = profile ? { what: `${profile.name}: ${profile.what ?? ""}`, phi_e_mm: (value("phi_e_solid_mm") + value("phi_e_void_mm")) / 2,
        phi_s_mm: value("phi_s_mm"), phi_v_mm: value("phi_v_mm") } : lists.printers.find((one) => one.name === s.printer);
    return p ? `${p.what}. ${text("phis", { solid: round(p.phi_s_mm), hollow: round(p.phi_v_mm), growth: round(p.phi_e_mm) })}` : "";
}

function printerGroup(lists, take) {
    const figures = (s) => s.printer === "", freely = (s) => !goesAround(s);
    return group("size",
        slider("width", "width", { min: 10, max: 400, step: 1, unit: "mm", show: freely }),
        slider("frame", "frame", { min: 0, max: 20, step: 0.5, unit: "mm" }),
        slider("thickness", "thickness", { min: 0.4, max: 20, step: 0.2, unit: "mm" }),
        menu("printer", "printer", printerChoices(lists)), note((s) => printerWords(s, lists)),
        make("div", { class: "tool-row" }, picker("chooseProfile", PROFILES, take)),
        slider("phi-e", "phi_e", { min: -0.5, max: 1, step: 0.01, unit: "mm", show: figures }),
        slider("phi-s", "phi_s", { min: 0.05, max: 3, step: 0.05, unit: "mm", show: figures }),
        slider("phi-v", "phi_v", { min: 0.05, max: 3, step: 0.05, unit: "mm", show: figures }),
        check("nudge", "nudge", { show: freely }));
}

function surfaceGroup(take, aspect) {
    const mesh = (s) => s.surface === "mesh", model = (s) => mesh(s) && s.mesh !== "", round_ = (s) => s.surface !== "plate" && !mesh(s);
    const placed = (s) => (round_(s) || model(s)) && !goesAround(s);
    return group("surface",
        menu("surface", "surface", ["plate", "cylinder", "vase", "cone", "sphere", "mesh"].map((name) => [name, text(name)])),
        note((s) => (s.mesh ? s.meshName : text("noMesh")), mesh),
        make("div", { class: "tool-row" }, picker("chooseMesh", MODELS, take)),
        slider("radius", "radius", { min: 10, max: 150, step: 1, unit: "mm", show: round_ }),
        slider("height", "height", { min: 20, max: 400, step: 5, unit: "mm", show: (s) => round_(s) && s.surface !== "sphere" }),
        check("around", "around", { show: canGoAround, more: (yes) => (yes ? { repeat: copiesAround(state(), aspect()) } : {}) }),
        slider("repeat", "copies", { min: 1, max: MOST_COPIES, step: 1, show: goesAround }), note(() => text("aroundHint"), goesAround),
        slider("meshHeight", "meshHeight", { min: 0, max: 400, step: 1, unit: "mm", show: model }),
        slider("meshTurn", "meshTurn", { min: -180, max: 180, step: 1, unit: "degree", show: model }),
        menu("meshUp", "meshUp", ["z", "y", "x", "-z", "-y", "-x"].map((axis) => [axis, axis]), { show: model }),
        menu("place", "place", ["auto", "project", "wrap"].map((way) => [way, text(`place_${way}`)]), { show: placed }),
        vectorField("at", "at", { step: 1, show: placed, hint: "atHint" }),
        vectorField("dir", "dir", { step: 0.1, show: (s) => placed(s) && placingOf(s) === "project" }));
}

function strengthGroup(lists) {
    const freely = (s) => !goesAround(s);
    return group("strength",
        note(() => text("noLoadAround"), goesAround),
        slider("force", "force", { min: 0, max: 500, step: 5, unit: "newton", show: freely }),
        menu("material", "material", lists.materials.map((m) => [m.name, m.name]), { show: freely }));
}

/** Fill the form anew, in the language that is set; aspect() is the picture's height over its width. */
export function showControls(form, lists, { take, openCrop, aspect }) {
    forget();
    form.replaceChildren(pictureGroup(lists, take, openCrop), printerGroup(lists, take), surfaceGroup(take, aspect), strengthGroup(lists));
    updateFields();
}
