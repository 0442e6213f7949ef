// Charts as files: a table of values, and a picture. Nothing leaves the machine: the browser saves what the page has.

const kLine_px = 18;

function quoted(text) {
  const plain = String(text).replace(/^[=+@\-]/, "'$&");  // a table program must not take a name for a formula
  return /[",\n\r]/.test(plain) ? `"${plain.replaceAll('"', '""')}"` : plain;
}

// parts: [{title, labels, units, columns: [times, values...]}], all with the same times (s since 1970).
export function csv_of(parts) {
  const shown = parts.filter(({labels}) => labels.length > 0);
  const heads = shown.flatMap(({title, labels, units}) => labels.map((label, i) => quoted(`${title}: ${label}${units[i] ? ` [${units[i]}]` : ""}`)));
  const rows = [["time (UTC)", ...heads].join(",")];
  const times = shown[0]?.columns[0] ?? [];
  times.forEach((time, row) => {
    const values = shown.flatMap(({columns}) => columns.slice(1).map((column) => column[row] ?? ""));
    rows.push([new Date(time * 1000).toISOString(), ...values].join(","));
  });
  return `${rows.join("\r\n")}\r\n`;
}

// A picture of charts, one below the other; null where there is none.
export function picture_of(charts) {
  const shown = charts.filter((chart) => chart.plot_area.clientWidth > 0 && !chart.plot_area.hidden);
  if (shown.length === 0) return null;
  const density = window.devicePixelRatio || 1;
  const width = Math.max(...shown.map(({plot_area}) => plot_area.clientWidth)) + 16;
  const height = shown.reduce((sum, {plot_area}) => sum + plot_area.clientHeight + 2 * kLine_px + 12, 8);
  const canvas = document.createElement("canvas");
  canvas.width = width * density;
  canvas.height = height * density;
  const pen = canvas.getContext("2d");
  pen.scale(density, density);
  const style = getComputedStyle(shown[0].plot_area);
  pen.fillStyle = getComputedStyle(document.getElementById("chart-panel")).backgroundColor;
  pen.fillRect(0, 0, width, height);
  let y = 8;
  for (const chart of shown) {
    y = draw_chart(pen, chart, y, style.color);
  }
  return canvas;
}

function draw_chart(pen, chart, top, text_colour) {
  pen.fillStyle = text_colour;
  pen.textBaseline = "top";
  pen.textAlign = "left";
  pen.font = "600 12px system-ui, sans-serif";
  pen.fillText(chart.caption, 8, top);
  const box = chart.plot_area.getBoundingClientRect();
  const at = (node) => {
    const place = node.getBoundingClientRect();
    return [8 + place.left - box.left, top + kLine_px + place.top - box.top, place.width, place.height];
  };
  for (const layer of chart.plot_area.querySelectorAll("canvas")) {
    const [x, y, width, height] = at(layer);
    pen.drawImage(layer, x, y, width, height);
  }
  pen.font = "11px system-ui, sans-serif";
  for (const label of chart.plot_area.querySelectorAll(".dygraph-axis-label")) {
    const [x, y, width] = at(label);
    pen.textAlign = getComputedStyle(label).textAlign === "right" ? "right" : getComputedStyle(label).textAlign === "center" ? "center" : "left";
    pen.fillText(label.textContent, x + (pen.textAlign === "right" ? width : pen.textAlign === "center" ? width / 2 : 0), y);
  }
  let x = 8;
  const below = top + kLine_px + box.height + 2;
  for (const {text, colour} of chart.entries) {
    const wide = pen.measureText(text).width;
    if (x + wide + 20 > box.width) break;  // what does not fit is in the table
    pen.textAlign = "left";
    pen.fillStyle = colour;
    pen.fillRect(x, below + 5, 10, 2);
    pen.fillStyle = text_colour;
    pen.fillText(text, x + 14, below);
    x += wide + 26;
  }
  return below + kLine_px + 10;
}

export function save(name, blob) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}
