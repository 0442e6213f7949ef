// The search of the theme fetches its index and starts a worker. A page of file:// may do neither: there the index comes by
// a script element, and what the worker would execute runs in a hidden frame. Elsewhere the worker is one.
"use strict";
var __search = {
  index: new Promise((resolve) => {
    window.cellmirrorSearchIndex = resolve;
    const script = document.createElement("script");
    script.src = cellmirrorSearchIndexFile;
    document.head.append(script);
  }),
};

// A Worker as far as the theme needs one: messages to and from the script at `address`.
class FrameWorker extends EventTarget {
  constructor(address) {
    super();
    const frame = document.createElement("iframe");
    frame.hidden = true;
    frame.title = "search";
    document.body.append(frame);
    this.inside = frame.contentWindow;
    this.inside.postMessage = (data) => this.dispatchEvent(new MessageEvent("message", { data }));
    const script = this.inside.document.createElement("script");
    script.src = address;
    this.loaded = new Promise((resolve) => script.addEventListener("load", resolve));
    this.inside.document.body.append(script);
  }

  postMessage(data) {
    this.loaded.then(() => this.inside.dispatchEvent(new this.inside.MessageEvent("message", { data })));
  }
}
if (location.protocol === "file:") window.Worker = FrameWorker;
