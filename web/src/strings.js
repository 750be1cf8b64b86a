// Every word of the page, in each language. Keys are the same everywhere; a missing one falls back to English.

const en = {
    lead: "A picture, carved right through, ready to print.",
    skip: "Skip to the picture",
    undo: "Undo", redo: "Redo", copyCommand: "Copy command line", copied: "Copied",
    language: "Language", controls: "What to make", stageName: "Preview", views: "View", results: "Result",
    viewPicture: "Picture", viewSolid: "Object",
    dropHere: "Let go to use this file",
    picture: "Picture", choose: "Choose a picture", orDrop: "or drop or paste one anywhere", samples: "Samples",
    threshold: "Threshold", auto: "automatic", byHand: "by hand", local: "follows the light", invert: "Swap black and white",
    levels: "Grey levels of the picture; {percent} % of it is white", window: "Neighbourhood (0: it chooses)", contrast: "Contrast",
    rotate: "Turn 90°", mirror: "Mirror", crop: "Crop", cropMove: "The part that is kept: drag it, or arrow keys; with Shift by one pixel",
    crop_nw: "Upper left corner", crop_n: "Upper edge", crop_ne: "Upper right corner", crop_e: "Right edge", crop_se: "Lower right corner",
    crop_s: "Lower edge", crop_sw: "Lower left corner", crop_w: "Left edge", cropLeft: "Left", cropTop: "Top", cropRatio: "Ratio",
    ratio_free: "free", ratio_asIs: "as it is", cropAll: "All of it", cropCancel: "Leave", cropDone: "Crop to this", px: "px",
    size: "Size and printer", width: "Width", frame: "Frame", thickness: "Thickness", printer: "Printer",
    ownPrinter: "three figures", ownFile: "a profile of your own", ownPrinters: "Your own", noProfile: "Choose or drop a profile.",
    chooseProfile: "Profile or slicer's configuration …", process_fdm: "Filament (FDM)", process_sla: "Resin (SLA)", process_sls: "Powder (SLS)",
    process_laser: "Laser", process_cutter: "Cutter", process_none: "Others",
    phis: "Narrowest solid {solid} mm, narrowest void {hollow} mm; bars come out {growth} mm wider.", phi_e: "Bars print wider by", phi_s: "Narrowest solid", phi_v: "Narrowest void",
    nudge: "Fine-tune edges to the printer (slower)",
    surface: "Surface", plate: "Plate", cylinder: "Cylinder", vase: "Vase", cone: "Cone", sphere: "Sphere", mesh: "Model of your own", chooseMesh: "Model: STL, OBJ, PLY, 3MF …", noMesh: "Choose or drop a model.",
    meshHeight: "Its height (0: as it is)", meshTurn: "Turned by", meshUp: "Its upward axis", place: "Picture on it", place_auto: "as suits it",
    place_project: "projected, as seen", place_wrap: "wrapped around", at: "Its middle, mm", atHint: "Empty: where there is most room. On the object it can be dragged.",
    dir: "Seen along", degree: "°",
    radius: "Radius", height: "Height",
    strength: "Strength", force: "Force pressed on it", material: "Material",
    handle: "Before and after: move with the arrow keys, 1 before, 2 both, 3 after",
    overlay: "Show", overlayNone: "nothing more", overlayError: "what prints wrong", overlayBridge: "bridges and changes",
    missing: "solid that is missing", excess: "solid that is too much", bridge: "made solid", opened: "made void",
    waiting: "Choose a picture to begin.", uploading: "Reading the file …", working: "Working …",
    progress: "Progress", cancel: "Cancel", again: "Run", cancelled: "Cancelled. What is shown is from before.",
    stage_read: "reading", stage_threshold: "black and white", stage_place: "placing", stage_flatten: "laying the surface flat",
    stage_connect: "connecting", stage_adapt: "adapting details", stage_finish: "making it printable", stage_nudge: "fine-tuning edges",
    stage_predict: "predicting the print", stage_medial_axis: "looking at fine lines", stage_trace: "tracing outlines",
    stage_triangulate: "triangulating", stage_carve: "carving", stage_offset: "hollowing", stage_mesh: "reading the model",
    stage_check: "checking the solid", stage_order: "preparing the load", stage_assemble: "setting up the load",
    stage_factor: "working out the load", stage_solve: "working out the load", stage_stress: "reading the stress",
    stage_reinforce: "reinforcing", stage_map: "drawing the stress", stage_write: "writing files", stage_report: "writing the report",
    stage_render: "drawing", stage_light: "drawing", stage_error_map: "drawing errors", stage_align: "aligning",
    done: "Done in {seconds} s.", failed: "That did not work: {sentence}", ready: "{name} is downloaded.",
    lost: "The connection to jali was lost. Is it still running?",
    onePiece: "One piece", printable: "Printable", closed: "Closed solid", sound: "Strong enough",
    kept: "yes", broken: "no", notAsked: "not asked",
    onePieceWhy: "{pieces} pieces in the picture, {bridges} bridges laid",
    printableWhy: "nothing thinner than {solid} mm, no void narrower than {hollow} mm",
    closedWhy: "{triangles} triangles, watertight", soundWhy: "{stress} of {limit} MPa",
    errorAsIs: "Printed as it is", errorConnected: "only connected", errorResult: "as carved here",
    wrong: "{percent} % wrong", volume: "{volume} cm³, {weight} g", download: "Download",
    report: "Report",
    front: "Front", back: "Back", side: "Side", topView: "Top", perspective: "Oblique", standardViews: "Look from", light: "Light inside",
    dimensions: "Dimensions", wall: "wall", layers: "What is shown", objectLayer: "Object", stressLayer: "Stress", displacementLayer: "Gives way",
    weakest: "Weakest place", stressIn: "Stress in {unit}", displacementIn: "Gives way by so many {unit}",
    belowLimit: "At most {most} {unit}; the material bears {limit}", aboveLimit: "Up to {most} {unit}; the material bears {limit}",
    largestMove: "At most {most} {unit}",
    solidHelp: "The carved object. Drag to turn, wheel or plus and minus to come nearer, arrow keys turn too, Home turns back",
    placePicture: "Place the picture", placeFound: "Back to the place that is found",
    placingHelp: "Drag the picture over the object, or move it with the arrow keys: 1 mm, with Shift 10. Beside the object you turn it.",
    noWebgl: "This browser cannot draw the object: it has no WebGL.",
    mm: "mm", newton: "N",
};

const zh = {
    lead: "把一张图片镂空雕穿，随时可以打印。",
    skip: "跳到图片",
    undo: "撤销", redo: "重做", copyCommand: "复制命令行", copied: "已复制",
    language: "语言", controls: "要做什么", stageName: "预览", views: "视图", results: "结果",
    viewPicture: "图片", viewSolid: "实物",
    dropHere: "松开即可使用此文件",
    picture: "图片", choose: "选择图片", orDrop: "也可以拖放或粘贴到任意位置", samples: "样例",
    threshold: "阈值", auto: "自动", byHand: "手动", local: "随光线变化", invert: "黑白互换",
    levels: "图片的灰度分布；{percent} % 为白", window: "邻域（0：自动）", contrast: "对比度",
    rotate: "旋转 90°", mirror: "镜像", crop: "裁剪", cropMove: "保留的部分：拖动，或用方向键；按住 Shift 每次一像素",
    crop_nw: "左上角", crop_n: "上边", crop_ne: "右上角", crop_e: "右边", crop_se: "右下角",
    crop_s: "下边", crop_sw: "左下角", crop_w: "左边", cropLeft: "左", cropTop: "上", cropRatio: "比例",
    ratio_free: "自由", ratio_asIs: "原比例", cropAll: "全部", cropCancel: "放弃", cropDone: "裁剪到此", px: "像素",
    size: "尺寸与打印机", width: "宽度", frame: "边框", thickness: "厚度", printer: "打印机",
    ownPrinter: "三个数值", ownFile: "自己的配置", ownPrinters: "自己的", noProfile: "请选择或拖入配置文件。",
    chooseProfile: "打印机或切片软件配置……", process_fdm: "线材 (FDM)", process_sla: "树脂 (SLA)", process_sls: "粉末 (SLS)",
    process_laser: "激光", process_cutter: "刻刀", process_none: "其他",
    phis: "最窄实体 {solid} 毫米，最窄空隙 {hollow} 毫米；实条变宽 {growth} 毫米。", phi_e: "实条打印后变宽", phi_s: "最窄实体", phi_v: "最窄空隙",
    nudge: "按打印机微调边缘（较慢）",
    surface: "曲面", plate: "平板", cylinder: "圆柱", vase: "花瓶", cone: "圆锥", sphere: "球", mesh: "自己的模型", chooseMesh: "模型：STL、OBJ、PLY、3MF……", noMesh: "请选择或拖入模型。",
    meshHeight: "模型高度（0：不变）", meshTurn: "转过", meshUp: "向上的轴", place: "图片放法", place_auto: "自动",
    place_project: "投影", place_wrap: "包裹", at: "图片中心（毫米）", atHint: "留空：最宽敞处。也可在实物上拖动。",
    dir: "观看方向", degree: "°",
    radius: "半径", height: "高度",
    strength: "强度", force: "承受的压力", material: "材料",
    handle: "前后对比：方向键移动，1 之前，2 两者，3 之后",
    overlay: "显示", overlayNone: "不叠加", overlayError: "打印误差", overlayBridge: "连接与改动",
    missing: "缺失的实体", excess: "多余的实体", bridge: "变为实体", opened: "变为空隙",
    waiting: "请先选择一张图片。", uploading: "正在读取文件……", working: "处理中……",
    progress: "进度", cancel: "取消", again: "运行", cancelled: "已取消。显示的是之前的结果。",
    stage_read: "读取", stage_threshold: "黑白化", stage_place: "放置", stage_flatten: "展平曲面",
    stage_connect: "连接", stage_adapt: "调整细节", stage_finish: "使其可打印", stage_nudge: "微调边缘",
    stage_predict: "预测打印结果", stage_medial_axis: "查看细线", stage_trace: "描轮廓",
    stage_triangulate: "三角剖分", stage_carve: "雕刻", stage_offset: "挖空", stage_mesh: "读取模型",
    stage_check: "检查实体", stage_order: "准备受力计算", stage_assemble: "建立受力计算",
    stage_factor: "计算受力", stage_solve: "计算受力", stage_stress: "读取应力",
    stage_reinforce: "加固", stage_map: "绘制应力", stage_write: "写文件", stage_report: "写报告",
    stage_render: "绘制", stage_light: "绘制", stage_error_map: "绘制误差", stage_align: "对齐",
    done: "用时 {seconds} 秒。", failed: "没有成功：{sentence}", ready: "{name} 已下载。",
    lost: "与 jali 的连接已断开。它还在运行吗？",
    onePiece: "连成一体", printable: "可以打印", closed: "封闭实体", sound: "足够坚固",
    kept: "是", broken: "否", notAsked: "未要求",
    onePieceWhy: "图片中有 {pieces} 块，架了 {bridges} 座桥",
    printableWhy: "实体不窄于 {solid} 毫米，空隙不窄于 {hollow} 毫米",
    closedWhy: "{triangles} 个三角形，水密", soundWhy: "{stress} / {limit} MPa",
    errorAsIs: "直接打印", errorConnected: "仅连接", errorResult: "本结果",
    wrong: "{percent} % 有误", volume: "{volume} cm³，{weight} 克", download: "下载",
    report: "报告",
    front: "正面", back: "背面", side: "侧面", topView: "俯视", perspective: "斜视", standardViews: "观看方向", light: "内部灯光",
    dimensions: "尺寸", wall: "壁厚", layers: "显示内容", objectLayer: "实物", stressLayer: "应力", displacementLayer: "变形",
    weakest: "最薄弱处", stressIn: "应力（{unit}）", displacementIn: "变形量（{unit}）",
    belowLimit: "最大 {most} {unit}；材料可承受 {limit}", aboveLimit: "达到 {most} {unit}；材料只能承受 {limit}",
    largestMove: "最大 {most} {unit}",
    solidHelp: "镂空后的实物。拖动旋转，滚轮或加减号缩放，方向键也可旋转，Home 键复位",
    placePicture: "放置图片", placeFound: "回到自动找到的位置",
    placingHelp: "在实物上拖动图片，或用方向键移动：每次 1 毫米，按住 Shift 为 10 毫米。在实物旁拖动则旋转实物。",
    noWebgl: "此浏览器没有 WebGL，无法显示实物。",
    mm: "毫米", newton: "牛",
};

const languages = { en, zh };
let current = "en";

export function setLanguage(name) {
    current = languages[name] ? name : "en";
    document.documentElement.lang = current === "zh" ? "zh-Hans" : "en";
}

export const language = () => current;

/** The words of a key, with {name} replaced by values.name. */
export function text(key, values = {}) {
    const words = languages[current][key] ?? en[key] ?? key;
    return words.replace(/\{(\w+)\}/g, (whole, name) => (name in values ? String(values[name]) : whole));
}

/** Fill in what index.html marks with data-text and data-label. */
export function fillWords(root) {
    for (const node of root.querySelectorAll("[data-text]")) node.textContent = text(node.dataset.text);
    for (const node of root.querySelectorAll("[data-label]")) node.setAttribute("aria-label", text(node.dataset.label));
}
