// The page: what the user chooses becomes jobs, what jobs give becomes pictures.
//
// Each change starts a preview (pictures alone) at once, and the whole run a moment later. Both belong to a client
// key, so the server stops the one before: the newest wins.

import * as api from "./api.js";
import { showControls, updateControls } from "./controls.js";
import { PictureView } from "./picture-view.js";
import { SolidView } from "./solid-view.js";
import { showResults } from "./results.js";
import { canRedo, canUndo, change, commandLine, onChange, options, readAddress, redo, state, undo } from "./state.js";
import { fillWords, language, setLanguage, text } from "./strings.js";

const PREVIEW_AFTER_MS = 40, WHOLE_AFTER_MS = 350;
const $ = (id) => document.getElementById(id);
const client = crypto.randomUUID();

const stage = $("stage");
const pictureView = new PictureView(stage, $("legend"));
const solidView = new SolidView(stage);

let lists;
let picture = null; // {id, name, blob}
let figures = null;
let lastJob = null; // the whole run whose files can be had
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

async function take(blob, name) {
    say("uploading");
    picture = { id: await api.upload(blob, name), name, blob };
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
        if (event.type === "failed") throw new api.Refusal(event.error);
    }
    throw new TypeError("the events ended early");
}

async function bitmapOf(id, name, signal) {
    return createImageBitmap(await (await api.file(id, name, signal)).blob());
}

async function showPictures(id, signal) {
    const [input, mask, print] = await Promise.all(["input.png", "mask.png", "print.png"].map((name) => bitmapOf(id, name, signal)));
    pictureView.show({ input, mask, print });
}

async function preview(signal) {
    const wanted = options();
    delete wanted.force;
    delete wanted.nudge;
    const id = await api.start({ picture: picture.id, verb: "adapt", options: wanted, client: `${client}-preview`,
        files: ["input.png", "mask.png", "print.png"] }, signal);
    await follow(id, signal);
    await showPictures(id, signal);
}

async function whole(signal) {
    const files = ["figures.json", "input.png", "mask.png", "print.png", "object.stl", "object.3mf", "report.html"];
    const flat = state().surface === "plate";
    if (flat) files.push("outline.svg", "outline.dxf");
    const id = await api.start({ picture: picture.id, verb: "carve", options: options(), client: `${client}-whole`, files }, signal);
    await follow(id, signal);
    figures = await (await api.file(id, "figures.json", signal)).json();
    lastJob = id;
    showFigures();
    say("done", { seconds: figures.seconds.total.toFixed(2) });
    await showPictures(id, signal);
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

async function download(name) {
    const blob = await (await api.file(lastJob, name)).blob();
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
    $("legend").hidden = name !== "picture";
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
    if (lists.picture) { change({ sample: "" }); picture = lists.picture; plan(); } // named on the command line
    else if (state().sample) await takeSample(state().sample);
    else say("waiting");
}

begin().catch(fail);
