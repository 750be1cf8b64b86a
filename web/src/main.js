// The page: what the user chooses becomes jobs, what jobs give becomes pictures.
//
// Each change starts a preview (pictures alone) at once, and the whole run a moment later. Both belong to a client
// key, so the server stops the one before: the newest wins.

import * as api from "./api.js";
import { showControls } from "./controls.js";
import { Crop } from "./crop.js";
import { Edit } from "./edit.js";
import { updateFields } from "./fields.js";
import { greyOf, levelsOf, listenForFiles, pictureOf, taken } from "./files.js";
import { showLevels, showThreshold } from "./levels.js";
import { PictureView } from "./picture-view.js";
import { showPlace } from "./placing-fields.js";
import { Placing } from "./placing.js";
import { Progress } from "./progress.js";
import { isProject, opened, saved } from "./project.js";
import { preview } from "./preview.js";
import { showResults } from "./results.js";
import { Plan, bitmapOf, bytesOf, run } from "./runs.js";
import { Smallest } from "./smallest.js";
import { SolidView } from "./solid-view.js";
import { canRedo, canUndo, change, commandLine, goesAround, job, onChange, readAddress, redo, state, undo } from "./state.js";
import { fillWords, language, setLanguage, text } from "./strings.js";

const WHOLE_FILES = ["figures.json", "input.png", "mask.png", "bridges.json", "bridges.png", "lost.png", "conflicts.png", "print.png", "errors.png", "mesh.bin"], STRENGTH_FILES = ["stress.bin", "displacement.bin"];
const PREVIEW_AFTER_MS = 25, LEVELS_AFTER_MS = 60, WHOLE_AFTER_MS = 350;
const $ = (id) => document.getElementById(id);

const stage = $("stage");
const pictureView = new PictureView(stage, $("legend"), $("bar"));
const edit = new Edit(pictureView, $("bar"), (key, values) => say(key, values));
const solidView = new SolidView(stage, (layer) => bytesOf(last.id, `${layer}.bin`));
const crop = new Crop(stage, (part) => change({ crop: part }), (hadFocus) => { selectView("picture"); if (hadFocus) $("crop").focus(); });
const placing = new Placing(solidView, { skin, size: sizeNow, picture: () => pictureView.before, found: () => figures?.place?.centre_mm });
const progress = new Progress($("progress"), cancel);
const plan = new Plan(fail);
const smallest = new Smallest(fail);

let lists;
let figures = null;
let counted = ""; // what the grey levels shown are of
let aspect = 1; // the picture's height over its width, by the last run in which it was there once
let last = null; // the whole run that is shown: {id, request, files}

const say = (key, values) => { $("status").textContent = text(key, values); };

function fail(error) {
    if (error.name === "AbortError") return;
    progress.hide();
    if (error instanceof api.Refusal) say("failed", { sentence: error.message });
    else if (error instanceof TypeError) say("lost");
    else throw error;
}

// --- Runs

async function showPictures(id, signal) {
    const json = async (name) => (await api.file(id, name, signal)).json();
    const [input, mask, bridges] = await Promise.all([bitmapOf(id, "input.png", signal), bitmapOf(id, "mask.png", signal), json("bridges.json")]);
    pictureView.show({ input, mask, layer: (name) => bitmapOf(id, name) });
    edit.show(bridges);
}

let previewed = Promise.resolve(); // the first preview that is under way, whether it fails or not

async function show(signal) {
    const pictures = await preview(state(), signal);
    if (!pictures || signal.aborted) return;
    pictureView.show(pictures, true);
    performance.mark("preview:drawn");
}

function first(signal) {
    const shown = show(signal);
    previewed = shown.catch(() => {});
    return shown;
}

// Not before the preview is there, which needs the processors itself.
async function whole(signal) {
    await previewed;
    signal.throwIfAborted();
    const { surface, thickness, force } = state(), flat = surface === "plate";
    const files = force > 0 && !goesAround(state()) ? [...WHOLE_FILES, ...STRENGTH_FILES] : WHOLE_FILES;
    const picture = await pictureOf(state());
    const request = { ...job(picture), verb: "carve" };
    const id = await run({ ...request, files }, "whole", signal, (name, fraction) => progress.tell(name, fraction));
    figures = await (await api.file(id, "figures.json", signal)).json();
    if (!goesAround(state())) aspect = figures.size_mm[1] / figures.size_mm[0];
    showPlace(figures.place);
    showThreshold(figures.input.threshold);
    updateFields();
    last = { id, request, files: new Set(files) };
    showFigures();
    await showPictures(id, signal);
    progress.hide();
    say("done", { seconds: figures.seconds.total.toFixed(2) });
    solidView.show(await bytesOf(id, "mesh.bin", signal), { flat, thickness, structure: figures.structure });
}

// The grey levels, when they are others.
async function levels(signal) {
    const picture = await pictureOf(state()), key = [picture.id, state().crop, state().invert].join();
    if (key === counted) return;
    showLevels(await levelsOf(picture, signal));
    counted = key;
    updateFields();
}

// A preview soon, the whole run when nothing changes for a while.
function begin() {
    if (!state().sample && !state().upload) return say("waiting");
    say("working");
    progress.show();
    plan.begin([[first, PREVIEW_AFTER_MS], [levels, LEVELS_AFTER_MS], [whole, WHOLE_AFTER_MS]]);
}

function cancel() {
    plan.end();
    progress.offer(begin);
    say("cancelled");
}

async function takeFile(file) {
    say("uploading");
    change(isProject(file.name) ? await opened(file) : await taken(file));
}

async function openCrop() {
    const picture = await pictureOf(state());
    if (!picture) return;
    selectView("picture");
    pictureView.root.hidden = true;
    crop.open(await greyOf(picture), state());
}

// The surface to lay pictures on, whether or not the present one fits there: that of a small one.
async function skin() {
    const request = job(await pictureOf(state()));
    const options = { surface: request.options.surface, width: "5", frame: "0", "no-predict": "true" };
    const id = await run({ ...request, verb: "adapt", files: ["surface.bin"], options }, "surface");
    return bytesOf(id, "surface.bin");
}

// The picture's size in mm, by its shape in the last run.
function sizeNow() {
    const [width, height] = figures?.size_mm ?? [1, 1];
    return [state().width, (state().width * height) / width];
}

// --- Results

function showFigures() {
    if (!figures) return;
    smallest.draw();
    const density = lists.materials.find((m) => m.name === (figures.structure?.material.name ?? state().material))?.density_g_cm3 ?? 1.24;
    showResults($("results"), figures, { density, smallest: smallest.root, download: (name) => download(name).catch(fail) });
}

// Files that were not made yet are made when they are wanted: the same request gives the same bytes.
async function fileOf(made, name) {
    if (made.files.has(name)) return (await api.file(made.id, name)).blob();
    const id = await run({ ...made.request, files: [name] }, name);
    return (await api.file(id, name)).blob();
}

function give(blob, name) {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(blob);
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 60000);
    say("ready", { name });
}

async function download(name) {
    give(await fileOf(last, name), last.request.name.replace(/\.\w+$/, "") + name.slice(name.lastIndexOf(".")));
}

async function save() {
    const { blob, name } = await saved(state());
    give(blob, name);
}

// --- The frame of it all

// What goes all around takes no edits by hand.
function showEdit() {
    edit.toggle.hidden = pictureView.root.hidden || goesAround(state());
    if (goesAround(state()) && edit.isOpen) edit.open(false);
}

function selectView(name) {
    if (crop.isOpen) crop.close();
    for (const kind of ["picture", "solid"]) {
        const tab = $(`tab-${kind}`);
        tab.setAttribute("aria-selected", String(kind === name));
        tab.tabIndex = kind === name ? 0 : -1;
    }
    pictureView.root.hidden = name !== "picture";
    $("legend").hidden = pictureView.chooser.hidden = name !== "picture";
    showEdit();
    solidView.root.hidden = name !== "solid";
    if (name === "solid") solidView.resize();
    else pictureView.draw();
}

function showWords() {
    fillWords(document);
    pictureView.words();
    edit.words();
    solidView.words();
    placing.words();
    showControls($("controls"), lists, { take: (file) => takeFile(file).catch(fail), openCrop: () => openCrop().catch(fail), aspect: () => aspect });
    progress.words();
    showFigures();
}

function listen() {
    for (const kind of ["picture", "solid"]) $(`tab-${kind}`).addEventListener("click", () => selectView(kind));
    document.querySelector(".views").addEventListener("keydown", (event) => {
        if (event.key !== "ArrowLeft" && event.key !== "ArrowRight") return;
        const other = $("tab-picture").getAttribute("aria-selected") === "true" ? "solid" : "picture";
        selectView(other);
        $(`tab-${other}`).focus();
    });
    $("undo").addEventListener("click", undo);
    $("redo").addEventListener("click", redo);
    addEventListener("keydown", (event) => {
        if (!(event.ctrlKey || event.metaKey)) return;
        if (event.key !== "s" && event.target.matches("input[type=number]")) return;
        if (event.key === "s") save().catch(fail);
        else if (event.key === "z") (event.shiftKey ? redo : undo)();
        else if (event.key === "y") redo();
        else return;
        event.preventDefault();
    });
    $("save").addEventListener("click", () => save().catch(fail));
    $("open").addEventListener("change", () => { for (const file of $("open").files) takeFile(file).catch(fail); $("open").value = ""; });
    $("copy").addEventListener("click", async () => {
        await navigator.clipboard.writeText(commandLine((await pictureOf(state()))?.name ?? "picture.png"));
        say("copied");
    });
    $("language").addEventListener("change", () => {
        localStorage.setItem("jali-language", $("language").value);
        setLanguage($("language").value);
        showWords();
    });
    addEventListener("keydown", (event) => { if (event.key === "Escape") { if (crop.isOpen) crop.close(); else if (progress.running) cancel(); } });
    listenForFiles($("drop"), (file) => takeFile(file).catch(fail));
    onChange(() => {
        updateFields();
        placing.refresh();
        smallest.refresh().catch(fail);
        showEdit();
        edit.draw();
        $("undo").disabled = !canUndo();
        $("redo").disabled = !canRedo();
        begin();
    });
}

async function open() {
    setLanguage(localStorage.getItem("jali-language") ?? (navigator.language.startsWith("zh") ? "zh" : "en"));
    $("language").value = language();
    readAddress();
    lists = await api.lists();
    showWords();
    listen();
    selectView("picture");
    const given = api.givenPicture();
    if (given) change({ sample: "", upload: given.id, uploadName: given.name });
    else begin();
}

open().catch(fail);
