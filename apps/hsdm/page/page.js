// The page round a mesh: legend, histogram, switches, places to look at, a still picture for print.
"use strict";
(function () {
    const get = (id) => document.getElementById(id);
    const data = hsdm.read(get("mesh"));
    const measured = !!data.deviations;

    // ---- Light and dark -------------------------------------------------------------------------------------

    const prefersDark = window.matchMedia && window.matchMedia("(prefers-color-scheme: dark)");
    let dark = !!(prefersDark && prefersDark.matches);
    const asked = new URLSearchParams(location.search);
    if (asked.has("dark")) dark = asked.get("dark") !== "0";

    // ---- Numbers --------------------------------------------------------------------------------------------

    const trim = (text) => text.includes(".") && !text.includes("e") ? text.replace(/\.?0+$/, "") : text;
    const number = (x, digits = 3) => (x < 0 ? "−" : "") + trim(Math.abs(x).toPrecision(digits));
    const signed = (x, digits) => (x > 0 ? "+" : "") + number(x, digits);
    const grouped = (n) => String(n).replace(/\B(?=(\d{3})+$)/g, ",");

    // ---- The view -------------------------------------------------------------------------------------------

    let view = null;
    const canvas = get("view");
    try {
        view = hsdm.view(canvas, data, {dark, software: asked.has("software") ? asked.get("software") === "1" : undefined, mode: measured ? "deviation" : data.confidence ? "confidence" : "plain"});
    } catch (error) {
        get("lacking").hidden = false;
        canvas.hidden = true;
        document.querySelector(".views").hidden = true;
        get("controls").hidden = true;
    }

    function setTheme(now) {
        dark = now;
        document.documentElement.dataset.theme = dark ? "dark" : "light";
        get("theme").setAttribute("aria-pressed", String(dark));
        if (view) view.set({dark});
        if (measured) drawHistogram();
    }

    const VIEWS = {front: [[0, -1, 0], [0, 0, 1]], right: [[1, 0, 0], [0, 0, 1]], top: [[0, 0, 1], [0, 1, 0]], slant: [[0.62, -0.72, 0.5], [0, 0, 1]]};
    function show(name) {
        if (VIEWS[name]) view.look(...VIEWS[name]);
        view.fit();
    }
    for (const button of document.querySelectorAll("[data-view]")) button.addEventListener("click", () => show(button.dataset.view));

    // ---- Legend ---------------------------------------------------------------------------------------------

    let range = data.range || 1;

    function ramp(scale) {
        const stops = [];
        for (let i = 0; i <= 16; ++i) stops.push(hsdm.css(hsdm.colorAt(scale, i / 16)) + " " + 100 * i / 16 + "%");
        return "linear-gradient(to top," + stops.join(",") + ")";
    }

    function drawLegend() {
        const mode = view ? view.state.mode : measured ? "deviation" : "plain";
        const texts = mode === "deviation" ? [1, 0.5, 0, -0.5, -1].map((x) => signed(x * range)) : mode === "confidence" ? ["1", "0.75", "0.5", "0.25", "0"] : [];
        for (const id of ["legend", "still-legend"]) {
            const legend = get(id);
            legend.textContent = "";
            if (!texts.length && !(mode === "plain" && view && view.state.points && measured)) continue;
            const bar = document.createElement("div"), list = document.createElement("ol");
            bar.className = "ramp";
            bar.style.background = ramp(mode === "confidence" ? hsdm.SHARE : hsdm.SIGNED);
            for (const text of texts.length ? texts : [1, 0.5, 0, -0.5, -1].map((x) => signed(x * range))) {
                const item = document.createElement("li");
                item.textContent = text;
                list.append(item);
            }
            legend.append(bar, list);
        }
    }

    // ---- Histogram ------------------------------------------------------------------------------------------

    const SVG = "http://www.w3.org/2000/svg";
    function shape(name, attributes, text) {
        const element = document.createElementNS(SVG, name);
        for (const key in attributes) element.setAttribute(key, attributes[key]);
        if (text !== undefined) element.textContent = text;
        get("histogram").append(element);
        return element;
    }

    // Bars over a little more than the scale, the outermost ones with all beyond.
    function drawHistogram() {
        const {counts, below, above, range: reach} = data.histogram;
        const shown = Math.min(reach, 1.25 * range), bars = 41, sums = new Array(bars).fill(0);
        let total = below + above, within = 0;
        sums[0] += below;
        sums[bars - 1] += above;
        counts.forEach((count, i) => {
            const d = ((i + 0.5) / counts.length * 2 - 1) * reach;
            // A bin's points are spread over the bars that it reaches into.
            const from = ((i / counts.length * 2 - 1) * reach / shown + 1) / 2 * bars, to = from + reach / shown * bars / counts.length;
            for (let b = Math.floor(from); b < to; ++b)
                sums[Math.min(bars - 1, Math.max(0, b))] += count * (Math.min(to, b + 1) - Math.max(from, b)) / (to - from);
            total += count;
            if (Math.abs(d) <= range) within += count;
        });
        const svg = get("histogram"), most = Math.max(...sums, 1), width = 320, height = 108;
        svg.textContent = "";
        sums.forEach((sum, i) => {
            const d = ((i + 0.5) / bars * 2 - 1) * shown, tall = sum ? Math.max(1.5, height * sum / most) : 0;
            const bar = shape("rect", {class: "bar", x: i * width / bars + 0.5, y: height - tall, width: width / bars - 1, height: tall,
                                       fill: hsdm.css(hsdm.colorAt(hsdm.SIGNED, 0.5 + 0.5 * Math.max(-1, Math.min(1, d / range))))});
            const title = document.createElementNS(SVG, "title");
            title.textContent = grouped(Math.round(sum)) + " points about " + signed(d);
            bar.append(title);
        });
        shape("line", {class: "axis", x1: 0, x2: width, y1: height + 0.5, y2: height + 0.5});
        for (const x of [-1, -0.5, 0, 0.5, 1]) {
            const at = width * (0.5 + 0.5 * x * range / shown);
            shape("line", {class: "axis", x1: at, x2: at, y1: height, y2: height + 4});
            shape("text", {x: Math.min(width - 2, Math.max(2, at)), y: height + 16, "text-anchor": at > width - 20 ? "end" : at < 20 ? "start" : "middle"}, signed(x * range, 2));
        }
        get("within").textContent = (within === total ? 100 : Math.floor(1000 * within / total) / 10) + " % of the points lie within ±" + number(range) + ".";
    }

    // The slider goes from a hundredth of the histogram's reach to all of it, in equal ratios.
    const slider = get("range");
    function setRange(now) {
        range = now;
        get("range-out").textContent = "±" + number(range);
        if (view) view.set({range});
        drawHistogram();
        drawLegend();
    }

    // ---- Switches -------------------------------------------------------------------------------------------

    function setMode(mode) {
        view.set({mode});
        const radio = document.querySelector(`input[name="mode"][value="${mode}"]`);
        radio.checked = true;
        drawLegend();
    }

    function toggle(name) {
        const box = get(name);
        if (box.disabled) return;
        view.set({[name]: box.checked = !view.state[name]});
        drawLegend();
    }

    function prepareSwitches() {
        const can = {deviation: measured, confidence: !!data.confidence, plain: true};
        for (const radio of document.querySelectorAll('input[name="mode"]')) {
            radio.closest("label").hidden = !can[radio.value];
            radio.addEventListener("change", () => setMode(radio.value));
        }
        if (data.facet_count > 15000) view.state.edges = false; // they would be closer than pixels
        for (const name of ["edges", "sharp", "points"]) {
            const box = get(name);
            box.checked = view.state[name];
            if (name === "points" && !data.points) box.closest("label").hidden = true;
            box.addEventListener("change", () => { view.set({[name]: box.checked}); drawLegend(); });
        }
        if (data.points) get("points-shown").textContent = "(" + grouped(data.points.length / 3) + ")";
        get("completed-hint").hidden = !(data.completed && data.completed.some((c) => c));
        setMode(view.state.mode);
    }

    // ---- Places ---------------------------------------------------------------------------------------------

    let place = null;
    function putMarker() {
        const marker = get("marker");
        marker.hidden = !place;
        if (!place) return;
        const {x, y, seen} = view.project(place);
        marker.hidden = !seen || x < 0 || x > 1 || y < 0 || y > 1;
        marker.style.left = 100 * x + "%";
        marker.style.top = 100 * y + "%";
    }

    function preparePlaces() {
        const buttons = [...document.querySelectorAll("[data-place]")];
        if (!document.querySelector(".places li")) {
            const item = document.createElement("li");
            item.textContent = "Nothing is known to be doubtful.";
            document.querySelector(".places").append(item);
        }
        for (const button of buttons) {
            button.addEventListener("click", () => {
                const again = button.getAttribute("aria-pressed") === "true";
                for (const other of buttons) other.setAttribute("aria-pressed", "false");
                place = again || !view ? null : button.dataset.place.split(" ").map(Number);
                if (place) {
                    button.setAttribute("aria-pressed", "true");
                    view.goTo(place);
                    const box = get("stage").getBoundingClientRect();
                    if (box.top < 0 || box.bottom > innerHeight + 80) get("stage").scrollIntoView({block: "start"});
                } else if (view) view.fit();
            });
            button.setAttribute("aria-pressed", "false");
        }
        if (view) view.onDraw(putMarker);
    }

    // What lies under a place that was clicked, not dragged over.
    function prepareProbe() {
        let from = null;
        canvas.addEventListener("pointerdown", (e) => { from = [e.clientX, e.clientY]; });
        canvas.addEventListener("pointerup", (e) => {
            if (!from || Math.hypot(e.clientX - from[0], e.clientY - from[1]) > 4) return;
            const box = canvas.getBoundingClientRect(), probe = get("probe");
            const hit = view.pick((e.clientX - box.left) / box.width, (e.clientY - box.top) / box.height);
            probe.hidden = !hit;
            if (hit) probe.textContent = hit.place.map((c) => number(c, 6)).join("  ")
                + (measured ? "\n" + (hit.deviation === null ? "no point near" : "deviation " + signed(hit.deviation)) : "")
                + (hit.confidence === null ? "" : "\nconfidence " + number(hit.confidence, 2));
            place = hit && hit.place;
            putMarker();
        });
    }

    // ---- All together ---------------------------------------------------------------------------------------

    if (measured) {
        const reach = data.histogram.range, least = reach / 100;
        slider.value = Math.round(1000 * Math.log(range / least) / Math.log(reach / least));
        slider.addEventListener("input", () => setRange(least * Math.pow(reach / least, slider.value / 1000)));
        slider.setAttribute("aria-label", "Ends of the colour scale");
        setRange(range);
    } else get("deviation-card").hidden = true;

    hsdm.shown = view;
    preparePlaces();
    get("theme").addEventListener("click", () => setTheme(!dark));
    setTheme(dark);
    if (!view) return;
    prepareSwitches();
    prepareProbe();

    document.addEventListener("keydown", (e) => {
        if (e.ctrlKey || e.altKey || e.metaKey || /^(INPUT|SELECT|TEXTAREA)$/.test(e.target.tagName)) return;
        const modes = ["deviation", "confidence", "plain"].filter((m) => m === "plain" || (m === "deviation" ? measured : data.confidence));
        const does = {
            1: () => show("front"), 2: () => show("right"), 3: () => show("top"), 4: () => show("slant"),
            c: () => setMode(modes[(modes.indexOf(view.state.mode) + 1) % modes.length]),
            e: () => toggle("edges"), s: () => toggle("sharp"), p: () => toggle("points"), d: () => setTheme(!dark),
        }[e.key.toLowerCase()];
        if (does) { e.preventDefault(); does(); }
    });

    window.addEventListener("beforeprint", () => {
        const still = get("still");
        still.src = view.picture(1500, 820);
        still.hidden = false;
    });
    window.addEventListener("afterprint", () => { get("still").hidden = true; });

    if (asked.has("bench")) view.bench(Number(asked.get("bench")) || 120, (result) => {
        document.title = "bench " + JSON.stringify(result);
        const probe = get("probe");
        probe.hidden = false;
        probe.textContent = result.fps.toFixed(1) + " pictures a second, " + grouped(result.triangles) + " triangles";
    });
    document.documentElement.dataset.ready = "yes";
})();
