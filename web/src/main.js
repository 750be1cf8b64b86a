// The page: what the user chooses becomes jobs, what jobs give becomes pictures.
//
// Each change starts a preview (pictures alone) at once, and the whole run a moment later. Both belong to a client
// key, so the server stops the one before: the newest wins.

import * as api from "./api.js";
import { showControls, showThreshold, updateControls } from "./controls.js";
import { PictureView } from "./picture-view.js";
import { SolidView } from "./solid-view.js";
import { showResults } from "./results.js";
import { canRedo, canUndo, change, commandLine, onChange, options, readAddress, redo, state, undo } from "./state.js";
import { fillWords, language, setLanguage, text } from "./strings.js";

const WHOLE_FILES = ["figures.json", "input.png", "mask.png", "errors.png", "object.stl"];
const PREVIEW_AFTER_MS = 40, WHOLE_AFTER_MS = 350, SVG_PX = 2000;
const $ = (id) => document.getElementById(id);
const client = crypto.randomUUID();

const stage = $("stage");
const pictureView = new PictureView(stage, $("legend"), $("bar"));
const solidView = new SolidView(stage);

let lists;
let picture = null; // {id, name}
let figures = null;
let last = null; // the whole run that is shown: {id, request, files}
let running = null; // AbortController of the present run
let timers = [];

const say = (key, values) => { $("status").textContent = text(key, values); };

function fail(error) {
    if (error.name === "AbortError") return;
    if (error instanceof api.Refusal) say("failed", { sentence: error.message });
    else if (error instanceof TypeError) say("lost");
    else throw error;
}

// --- Pictures

// An SVG is drawn here: the program's shut-in processes load no fonts.
async function drawn(blob) {
    const image = new Image();
    image.src = URL.createObjectURL(blob);
    await image.decode();
    const width = image.naturalWidth || 1000, height = image.naturalHeight || 1000, scale = SVG_PX / Math.max(width, height);
    const canvas = new OffscreenCanvas(Math.round(width * scale), Math.round(height * scale));
    const context = canvas.getContext("2d");
    context.fillStyle = "#fff";
    context.fillRect(0, 0, canvas.width, canvas.height);
    context.drawImage(image, 0, 0, canvas.width, canvas.height);
    URL.revokeObjectURL(image.src);
    return canvas.convertToBlob({ type: "image/png" });
}

async function take(blob, name) {
    say("uploading");
    const bytes = blob.type === "image/svg+xml" ? await drawn(blob) : blob;
    picture = { id: await api.upload(bytes), name };
    plan();
}

const takeFile = (file) => { change({ sample: "" }); take(file, file.name).catch(fail); };

async function takeSample(name) {
    change({ sample: name });
    await take(await api.sample(name), `${name}.png`);
}

function listenForFiles() {
    const cover = $("drop");
    addEventListener("dragover", (event) => { event.preventDefault(); cover.hidden = false; });
    addEventListener("dragleave", (event) => { if (!event.relatedTarget) cover.hidden = true; });
    addEventListener("drop", (event) => {
        event.preventDefault();
        cover.hidden = true;
        if (event.dataTransfer.files[0]) takeFile(event.dataTransfer.files[0]);
    });
    addEventListener("paste", (event) => { if (event.clipboardData.files[0]) takeFile(event.clipboardData.files[0]); });
}

// --- Runs

// Follow a job to its end; its figures.
async function follow(id, signal) {
    for await (const event of api.events(id, signal)) {
        if (event.type === "progress") say("working", { stage: event.stage });
        if (event.type === "done") return event;
        if (event.type === "failed") throw new api.Refusal(event.message);
    }
    throw new TypeError("the events ended early");
}

async function bitmapOf(id, name, signal) {
    return createImageBitmap(await (await api.file(id, name, signal)).blob());
}

async function showPictures(id, signal, errors) {
    const names = ["input.png", "mask.png", ...(errors ? ["errors.png"] : [])];
    const [input, mask, wrong] = await Promise.all(names.map((name) => bitmapOf(id, name, signal)));
    pictureView.show({ input, mask, wrong });
}

async function preview(signal) {
    const wanted = options();
    for (const key of ["force", "material", "nudge", "thickness"]) delete wanted[key];
    const id = await api.start({ picture: picture.id, name: picture.name, verb: "adapt",
        options: { ...wanted, "no-predict": true }, client: `${client}-preview`, files: ["input.png", "mask.png"] }, signal);
    await follow(id, signal);
    await showPictures(id, signal, false);
}

async function whole(signal) {
    const flat = state().surface === "plate";
    const request = { picture: picture.id, name: picture.name, verb: "carve", options: options() };
    const id = await api.start({ ...request, client: `${client}-whole`, files: WHOLE_FILES }, signal);
    await follow(id, signal);
    figures = await (await api.file(id, "figures.json", signal)).json();
    showThreshold(figures.input.threshold);
    last = { id, request, files: new Set(WHOLE_FILES) };
    showFigures();
    say("done", { seconds: figures.seconds.total.toFixed(2) });
    await showPictures(id, signal, true);
    solidView.show(await (await api.file(id, "object.stl", signal)).arrayBuffer(), flat);
}

// A preview soon, the whole run when nothing changes for a while.
function plan() {
    if (!picture) return;
    running?.abort();
    timers.forEach(clearTimeout);
    running = new AbortController();
    const { signal } = running;
    timers = [[preview, PREVIEW_AFTER_MS], [whole, WHOLE_AFTER_MS]].map(([run, after]) => setTimeout(() => run(signal).catch(fail), after));
}

// --- Results

function showFigures() {
    if (figures) showResults($("results"), figures, lists.materials, state().material, (name) => download(name).catch(fail));
}

// Files that were not made yet are made when they are wanted: the same request gives the same bytes.
async function fileOf(run, name) {
    if (run.files.has(name)) return (await api.file(run.id, name)).blob();
    const id = await api.start({ ...run.request, client: `${client}-${name}`, files: [name] });
    await follow(id);
    return (await api.file(id, name)).blob();
}

async function download(name) {
    const blob = await fileOf(last, name);
    say("ready", { name: name.slice(name.lastIndexOf(".") + 1).toUpperCase() });
    const link = document.createElement("a");
    link.href = URL.createObjectURL(blob);
    link.download = picture.name.replace(/\.\w+$/, "") + name.slice(name.lastIndexOf("."));
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}

// --- The frame of it all

function selectView(name) {
    for (const kind of ["picture", "solid"]) {
        const tab = $(`tab-${kind}`);
        tab.setAttribute("aria-selected", String(kind === name));
        tab.tabIndex = kind === name ? 0 : -1;
    }
    pictureView.root.hidden = name !== "picture";
    $("legend").hidden = pictureView.chooser.hidden = name !== "picture";
    solidView.root.hidden = name !== "solid";
    if (name === "solid") solidView.resize();
    else pictureView.draw();
}

function showWords() {
    fillWords(document);
    pictureView.words();
    solidView.words();
    showControls($("controls"), lists, takeFile, (name) => takeSample(name).catch(fail));
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
        if (!(event.ctrlKey || event.metaKey) || event.target.matches("input[type=number]")) return;
        if (event.key === "z") (event.shiftKey ? redo : undo)();
        else if (event.key === "y") redo();
        else return;
        event.preventDefault();
    });
    $("copy").addEventListener("click", async () => {
        await navigator.clipboard.writeText(commandLine(picture?.name ?? "picture.png"));
        say("copied");
    });
    $("language").addEventListener("change", () => {
        localStorage.setItem("jali-language", $("language").value);
        setLanguage($("language").value);
        showWords();
    });
    listenForFiles();
    onChange((now, keys) => {
        updateControls();
        $("undo").disabled = !canUndo();
        $("redo").disabled = !canRedo();
        if (keys.includes("sample") && now.sample && picture?.name !== `${now.sample}.png`) takeSample(now.sample).catch(fail);
        else if (keys.some((key) => key !== "sample")) plan();
    });
}

async function begin() {
    setLanguage(localStorage.getItem("jali-language") ?? (navigator.language.startsWith("zh") ? "zh" : "en"));
    $("language").value = language();
    readAddress();
    lists = await api.lists();
    showWords();
    listen();
    selectView("picture");
    if (api.givenPicture()) {
        change({ sample: "" });
        picture = api.givenPicture();
        plan();
    } else if (state().sample) await takeSample(state().sample);
    else say("waiting");
}

begin().catch(fail);
