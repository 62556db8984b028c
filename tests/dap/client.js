// A session with `s7200 dap` over the public client, and what the tests need of it.
"use strict";
const { DebugClient } = require("@vscode/debugadapter-testsupport");

const S7200 = process.env.S7200;
const FEATURES = {
  adapterID: "s7200", pathFormat: "path", linesStartAt1: true, columnsStartAt1: true, supportsProgressReporting: true,
  supportsMemoryEvent: true, supportsInvalidatedEvent: true, supportsVariableType: true, supportsMemoryReferences: true,
};

class Session {
  constructor(log = () => {}) {
    this.client = new DebugClient(S7200, "dap", "s7200");
    this.client.defaultTimeout = 60000;
    this.log = log;
    this.printed = "";
    this.events = [];
  }

  async start(port) {
    await this.client.start(port);
    for (const kind of ["output", "stopped", "memory", "progressStart", "progressEnd", "invalidated", "terminated", "exited"])
      this.client.on(kind, (event) => this.events.push(event));
    this.client.on("output", (event) => { this.printed += event.body.output; });
    return (await this.client.initializeRequest(FEATURES)).body;
  }

  // The body of a good response.
  async ask(command, args = {}) {
    this.log("request", command, args);
    const { body } = await this.client.customRequest(command, args);
    if (body && body.text) this.log("said", body.text);
    return body;
  }

  // What a request that is refused says.
  async refused(command, args = {}) {
    try {
      await this.client.customRequest(command, args);
    } catch (error) {
      return error.message;
    }
    throw new Error(`${command} was not refused`);
  }

  // The body of the stop that a request leads to.
  async stops(command, args = {}) {
    const stopped = this.client.waitForEvent("stopped");
    const [event] = await Promise.all([stopped, this.ask(command, { threadId: 1, ...args })]);
    this.log("stopped", event.body);
    return event.body;
  }

  // Up to the first stop; `before` sets breakpoints.
  async begin(launch, before = async () => {}, request = "launch") {
    const initialized = this.client.waitForEvent("initialized");
    await Promise.all([initialized, this.ask(request, launch)]);
    await before();
    return this.stops("configurationDone");
  }

  async frame(number = 0) {
    const frame = (await this.ask("stackTrace", { threadId: 1 })).stackFrames[number];
    this.log("frame", frame);
    return frame;
  }

  async value(expression, context = "watch") {
    return (await this.ask("evaluate", { expression, context })).result;
  }

  async scope(name, frameId = 1) {
    const scope = (await this.ask("scopes", { frameId })).scopes.find((one) => one.name === name);
    return (await this.ask("variables", { variablesReference: scope.variablesReference })).variables;
  }

  // All of it that can be compared.
  async state() {
    const areas = ["V", "M", "SM", "Q", "T", "C", "AC", "S"];
    const memory = [];
    for (const area of areas)
      memory.push((await this.client.customRequest("readMemory", { memoryReference: area, count: 20000 })).body.data);
    return JSON.stringify([memory, await this.scope("Runtime"), await this.frame()]);
  }

  async disconnect() {
    this.disconnected = true;
    await this.client.disconnectRequest();
  }

  async end() {
    if (this.disconnected) this.client.stopAdapter();
    else await this.client.stop();
  }
}

module.exports = { Session };
