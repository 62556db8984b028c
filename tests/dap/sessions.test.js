// A session for each capability, with our slave and with the tip where it is.
"use strict";
const { test, after } = require("node:test");
const assert = require("node:assert/strict");
const { spawn } = require("node:child_process");
const fs = require("node:fs");
const net = require("node:net");
const os = require("node:os");
const path = require("node:path");
const { Session } = require("./client.js");

const { S7200, SOURCE } = process.env;
const SLAVE = path.join(SOURCE, "stl_programs/modbus_slave.stl");
const TIP = path.join(SOURCE, "../shared/seeds/tip41_modbus_rtu_slave.txt");
const READ = "01 03 00 0a 00 01 crc";
const folder = fs.mkdtempSync(path.join(os.tmpdir(), "s7200-dap-"));
after(() => fs.rmSync(folder, { recursive: true }));

const PROGRAMS = [{ name: "our slave", program: SLAVE }];
if (fs.existsSync(TIP)) PROGRAMS.push({ name: "the tip", program: TIP });
else console.log(`without the tip: there is no ${TIP}`);

// One session for each program, which ends whatever happens in it.
function session(name, run) {
  for (const { name: of, program } of PROGRAMS)
    test(`${name} (${of})`, async () => {
      const s = new Session();
      try {
        await run(s, program, await s.start());
      } finally {
        await s.end();
      }
    });
}

const named = (name, more = {}) => ({ breakpoints: [{ name, ...more }] });
const at_int_123 = (s) => s.ask("setFunctionBreakpoints", named("INT 123"));

session("what is announced is offered", async (s, program, capabilities) => {
  assert.equal(capabilities.supportsStepBack, true);
  assert.deepEqual(capabilities.exceptionBreakpointFilters.map((one) => one.filter),
    ["error", "overflow", "lost", "unanswered", "wrong", "watchdog"]);
  assert.equal((await s.begin({ program, stopOnEntry: true })).reason, "entry");
  assert.match(await s.refused("modules"), /not a request that is offered/);
  assert.equal((await s.ask("loadedSources")).sources[0].path, fs.realpathSync(program));
  assert.equal((await s.ask("threads")).threads[0].name, "CPU 214");
});

test("stand-ins for libraries are sources that the client asks for", async () => {
  const s = new Session();
  try {
    await s.start();
    const program = path.join(SOURCE, "tests/programs/libraries/slave.awl");
    await s.begin({ program, cpu: "224", stopOnEntry: true });
    const [, stand_in] = (await s.ask("loadedSources")).sources;
    assert.equal(stand_in.path, "stand-in:modbus_slave.awl");
    const { content } = await s.ask("source", { source: stand_in, sourceReference: stand_in.sourceReference });
    const line = content.split("\n").findIndex((each) => each.startsWith("SUBROUTINE_BLOCK MBUS_SLAVE")) + 1;
    assert.ok(line > 0);
    const [breakpoint] = (await s.ask("setBreakpoints", { source: stand_in, breakpoints: [{ line }] })).breakpoints;
    assert.equal(breakpoint.verified, true);
    assert.match(await s.refused("source", { sourceReference: 99 }), /read them by their paths/);
  } finally {
    await s.end();
  }
});

session("a launch takes the options of debug, and says what is wrong with them", async (s, program) => {
  assert.match(await s.refused("launch", {}), /'program' is missing/);
  assert.match(await s.refused("launch", { program, frob: 1 }), /no attribute 'frob'/);
  assert.match(await s.refused("launch", { program, cpu: "999" }), /no model of CPU '999'/);
  assert.match(await s.refused("launch", { program: path.join(folder, "missing.stl") }), /missing.stl/);
  assert.match(await s.refused("launch", { program, set: ["VB99999=1"] }), /VB99999/);
  assert.match(await s.refused("launch", { program, send: "frob" }), /frob/);
});

session("a value of the wrong type is named with what it should be", async (s, program) => {
  const wrong = {
    trace: [true, /^trace: true is not FILE: a text or a number$/], realtime: ["yes", /^realtime: "yes" is not true or false$/],
    set: [{ VW10: { a: 5 } }, /^set: \{"a":5\} is not ADDRESS=VALUE: a text or a number$/], cpu: [["214", "224"], /^cpu: \["214","224"\] is not one TYPE$/],
    program: [5, /^program: 5 is not a text or a list of texts$/], stopOnEntry: [1, /^stopOnEntry: 1 is not true or false$/],
    cwd: [7, /^cwd: 7 is not a text$/], input: ["a\0b", /^input: "a\\u0000b" is not a text without the character NUL$/],
    speed: ["fast", /--speed: 'fast' is not a number/], help: [true, /^launch: there is no attribute 'help'/], memry: ["a", /did you mean 'memory'/],
    version: [true, /no attribute 'version'/], ramLost: [true, /--ram-lost requires --memory/],
    clockError: ["1", /--clock-error: .1. is not from -1000ppm to 1000ppm/],
  };
  for (const [key, [value, said]] of Object.entries(wrong)) assert.match(await s.refused("launch", { program, [key]: value }), said);
});

session("relative paths begin at cwd, and a URI is a path", async (s, program) => {
  const cwd = fs.mkdtempSync(path.join(folder, "cwd with blanks-"));
  fs.copyFileSync(program, path.join(cwd, path.basename(program)));
  assert.match(await s.refused("launch", { program: path.basename(program), cwd: path.join(cwd, "none") }), /cwd: '.*' is not a folder/);
  await s.begin({ program: path.basename(program), cwd: "file://" + cwd.replaceAll(" ", "%20"), trace: "run.trace", stopOnEntry: true });
  const source = { path: "file://" + encodeURI(path.join(cwd, path.basename(program))) };
  assert.equal((await s.ask("breakpointLocations", { source, line: 1, endLine: 100000 })).breakpoints.length > 10, true);
  await s.ask("terminate");
  assert.ok(fs.existsSync(path.join(cwd, "run.trace")));
});

session("a launch that was refused can be mended", async (s, program) => {
  assert.match(await s.refused("launch", { program: path.join(folder, "missing.stl") }), /missing.stl/);
  const trace = path.join(folder, `launch-${path.basename(program)}.trace`);
  await s.begin({ program, stopOnEntry: true, set: ["VW20=16#1234", "M0.3=1"], cpu: "216", trace });
  assert.equal(await s.value("VW20"), "16#1234 (4660)");
  assert.equal((await s.ask("threads")).threads[0].name, "CPU 216");
  await s.stops("stepScan");
  await s.ask("terminate");
  assert.match(fs.readFileSync(trace, "utf8"), /# time in ms/);
});

session("a frame that the launch sends is answered", async (s, program) => {
  const hit = await s.begin({ program, send: READ }, () => s.ask("setFunctionBreakpoints", named("sent")));
  assert.equal(hit.reason, "function breakpoint");
  await s.ask("setFunctionBreakpoints", { breakpoints: [] });
  await s.stops("stepScan", { count: 3 });
  const { result } = await s.ask("evaluate", { expression: "timeline", context: "repl" });
  assert.match(result, /XMT|transmit/i);
});

session("breakpoints: lines, conditions, hits and messages", async (s, program) => {
  await s.begin({ program, send: READ }, () => at_int_123(s));
  const { line, source } = await s.frame();
  await s.ask("setFunctionBreakpoints", { breakpoints: [] });
  const place = async (more) => (await s.ask("setBreakpoints", { source, breakpoints: [{ line, ...more }] })).breakpoints[0];
  assert.deepEqual([(await place({ condition: "SMB2 = 16#0A" })).verified, (await s.stops("continue")).reason], [true, "breakpoint"]);
  assert.equal(await s.value("SMB2"), "16#0A (10)");
  await place({ hitCondition: "2" });
  await s.stops("continue");
  assert.equal(await s.value("SMB2"), "16#01 (1)");
  await place({ logMessage: "{SMB2} at line {line}" });
  await s.stops("stepScan", { count: 20 });
  assert.match(s.printed, new RegExp(`\\d+ at line ${line}`));
  assert.equal((await place({ condition: "frob" })).verified, false);
  assert.deepEqual((await s.ask("breakpointLocations", { source, line })).breakpoints, [{ line }]);
});

session("function breakpoints: subroutines, interrupt routines, events", async (s, program) => {
  const hit = await s.begin({ program, send: READ }, () => s.ask("setFunctionBreakpoints", named("event 8 occurs")));
  assert.equal(hit.reason, "function breakpoint");
  await s.ask("setFunctionBreakpoints", named("port 0: character received"));
  await s.stops("continue");
  assert.match((await s.frame()).name, /^INT 12\d for event 8/);
  await s.ask("setFunctionBreakpoints", named("SBR 51"));
  await s.stops("continue");
  assert.equal((await s.frame()).name, "SBR 51");
  await s.ask("setFunctionBreakpoints", named("received"));
});

session("data breakpoints: bytes that change, are read, are written", async (s, program) => {
  const watch = (dataId, accessType) => s.ask("setDataBreakpoints", { breakpoints: [{ dataId, accessType }] });
  const hit = await s.begin({ program, send: READ }, async () => {
    const { dataId } = await s.ask("dataBreakpointInfo", { name: "VB3300", bytes: 2 });
    assert.equal(dataId, "VB3300:2");
    await watch(dataId, "write");
  });
  assert.equal(hit.reason, "data breakpoint");
  assert.match(hit.text, /was .* is .*, by /s);
  await watch("VW3300", "read");
  assert.equal((await s.stops("continue")).reason, "data breakpoint");
});

session("instruction breakpoints stand in the disassembly", async (s, program) => {
  await s.begin({ program, stopOnEntry: true });
  const start = (await s.frame()).instructionPointerReference;
  const { instructions } = await s.ask("disassemble", { memoryReference: start, instructionOffset: -2, instructionCount: 40 });
  assert.equal(instructions.length, 40);
  assert.equal(instructions[0].presentationHint, "invalid");
  assert.match(instructions[2].instruction, /LD +SM0\.1 .*us/);
  const { instructionPointerReference } = await (async () => { await s.stops("stepIn"); return s.frame(); })();
  await s.ask("setInstructionBreakpoints", { breakpoints: [{ instructionReference: instructionPointerReference }] });
  assert.equal((await s.stops("continue")).reason, "instruction breakpoint");
  assert.equal((await s.frame()).instructionPointerReference, instructionPointerReference);
});

session("exception filters: an unanswered request, and what it was", async (s, program) => {
  const hit = await s.begin({ program, send: "01 03 00 0a 00 01 00 00" },
    () => s.ask("setExceptionBreakpoints", { filters: ["unanswered"] }));
  assert.equal(hit.reason, "exception");
  assert.equal((await s.ask("exceptionInfo", { threadId: 1 })).exceptionId, "unanswered request");
});

session("steps: instruction, line, network, over, into, out, scan", async (s, program) => {
  await s.begin({ program, stopOnEntry: true });
  const first = await s.frame();
  await s.stops("next", { granularity: "instruction" });
  assert.ok((await s.frame()).line > first.line);
  await s.stops("stepIn", { granularity: "line" });
  const inside = await s.frame();
  assert.match(inside.name, /^SBR/);
  assert.equal((await s.ask("stackTrace", { threadId: 1 })).totalFrames, 2);
  await s.stops("stepOut");
  assert.equal((await s.frame()).name, "main");
  await s.stops("stepScan");
  await s.stops("next", { granularity: "statement" });
  await s.stops("stepScan", { count: 3 });
  assert.match(await s.refused("stepOut", { threadId: 1 }), /main program/);
});

session("all of it backwards: the state is what it was", async (s, program) => {
  await s.begin({ program, send: READ }, () => at_int_123(s));
  const there = await s.state();
  await s.stops("stepBack", { count: 7 });
  await s.stops("stepIn");
  await s.stops("reverseStepOver");
  await s.stops("reverseStepScan");
  await s.stops("continue");
  assert.equal(await s.state(), there);
  await s.stops("reverseStepOut");
  assert.match((await s.frame()).name, /^(main|SBR)/);
  await s.ask("setFunctionBreakpoints", { breakpoints: [] });
  const oldest = await s.stops("reverseContinue");
  assert.match(oldest.description, /oldest moment/);
});

session("random walks forwards and backwards stand where a plain run has been", async (s, program) => {
  await s.begin({ program, send: READ }, () => at_int_123(s));
  const states = [await s.state()];
  let at = 0, random = 1;
  for (let step = 0; step < 60; ++step) {
    random = (Math.imul(random, 1664525) + 1013904223) >>> 0;
    const back = random >= 2 ** 31 && at > 0;
    await s.stops(back ? "stepBack" : "stepIn");
    at += back ? -1 : 1;
    const now = await s.state();
    if (states.length <= at) states.push(now);
    // what is newest depends on the walk, everything else does not
    const plain = (text) => text.replace(/"name":"newest moment","value":"[^"]*"/, "");
    assert.equal(plain(now), plain(states[at]));
  }
});

session("a run is paused, and goes on", async (s, program) => {
  const initialized = s.client.waitForEvent("initialized");
  await Promise.all([initialized, s.ask("launch", { program })]);
  await s.ask("configurationDone");
  const while_running = await s.value("VW3292");
  assert.match(while_running, /^16#/);
  assert.match(await s.refused("next", { threadId: 1 }), /runs: pause it first/);
  assert.equal((await s.stops("pause")).reason, "pause");
  await s.ask("continue", { threadId: 1 });
  assert.equal((await s.stops("pause")).reason, "pause");
});

session("the stack, the scopes and their variables", async (s, program) => {
  await s.begin({ program, send: READ }, () => at_int_123(s));
  const { stackFrames } = await s.ask("stackTrace", { threadId: 1 });
  assert.match(stackFrames[0].name, /^INT 123 for event 8/);
  assert.equal(stackFrames[0].source.path, fs.realpathSync(program));
  const { scopes } = await s.ask("scopes", { frameId: stackFrames[0].id });
  assert.deepEqual(scopes.map((one) => one.name), ["Logic stack", "AC", "I", "Q", "M", "V", "SM", "S", "T", "C", "HC", "AI", "AQ",
    "Port", "Runtime"].filter((name) => scopes.some((one) => one.name === name)));
  assert.ok(scopes.length >= 13);
  for (const { memoryReference } of scopes)
    assert.ok((await s.ask("readMemory", { memoryReference, count: 1 })).data, memoryReference);
  assert.equal((await s.scope("Logic stack"))[0].value, "1");
  await s.ask("writeMemory", { memoryReference: "stack", data: "AA==" });
  assert.equal((await s.scope("Logic stack"))[0].value, "0");
  assert.ok(s.events.some((one) => one.event === "memory" && one.body.memoryReference === "stack"));
  await s.ask("setVariable", { variablesReference: scopes[0].variablesReference, name: "S0", value: "1" });
  assert.ok((await s.scope("V")).some((one) => one.evaluateName === "VW3300"));
  assert.ok((await s.scope("SM")).some((one) => one.name === "SMB30 Freeport: port control" && one.value.startsWith("16#49")));
  assert.ok((await s.scope("Port")).some((one) => one.name === "SMB30" && one.value.includes("Freeport")));
  assert.ok((await s.scope("Runtime")).some((one) => one.name === "serving"));
});

session("expressions, hover, completions", async (s, program) => {
  await s.begin({ program, send: READ }, () => at_int_123(s));
  assert.equal(await s.value("VW3300 + 1 > VW3300"), "1");
  assert.equal((await s.ask("evaluate", { expression: "SMB2", context: "hover" })).memoryReference, "SMB2");
  assert.match(await s.refused("evaluate", { expression: "LBL" }), /not an address/);
  const { targets } = await s.ask("completions", { text: "VW330", column: 6 });
  assert.ok(targets.some((one) => one.label === "VW3300"));
});

session("variables are set, memory is read and written, and changes are told", async (s, program) => {
  await s.begin({ program, stopOnEntry: true });
  await s.ask("readMemory", { memoryReference: "VB100", count: 4 });
  assert.equal((await s.ask("writeMemory", { memoryReference: "VB100", data: "EjQ=" })).bytesWritten, 2);
  assert.equal(await s.value("VW100"), "16#1234 (4660)");
  assert.equal((await s.ask("setExpression", { expression: "VW102", value: "-1" })).value, "16#FFFF (-1)");
  const ac = (await s.ask("scopes", { frameId: 1 })).scopes.find((one) => one.name === "AC").variablesReference;
  assert.equal((await s.ask("setVariable", { variablesReference: ac, name: "AC0", value: "5" })).value, "16#00000005 (5)");
  assert.equal((await s.ask("readMemory", { memoryReference: "V", offset: 100, count: 4 })).data, "EjT//w==");
  assert.ok(s.events.some((one) => one.event === "memory" && one.body.offset === 0));
  assert.match(await s.refused("setExpression", { expression: "VB0", value: "300" }), /not a value that fits/);
});

session("goto leads within the routine", async (s, program) => {
  await s.begin({ program, stopOnEntry: true });
  const first = await s.frame();
  await s.stops("next");
  const second = await s.frame();
  const { targets } = await s.ask("gotoTargets", { source: first.source, line: first.line });
  assert.equal((await s.stops("goto", { targetId: targets[0].id })).reason, "goto");
  assert.equal((await s.frame()).line, first.line);
  await s.stops("next");
  assert.equal((await s.frame()).line, second.line);
});

session("frames are sent from the console and by a request", async (s, program) => {
  await s.begin({ program, stopOnEntry: true });
  await s.stops("stepScan", { count: 50 });
  await s.ask("evaluate", { expression: `send ${READ}`, context: "repl" });
  assert.match(await s.refused("sendFrame", { frame: "01" }), /still under way/);
  await s.ask("setFunctionBreakpoints", named("sent"));
  await s.stops("continue");
  assert.match((await s.ask("timeline")).text, /ms|us/);
  assert.match((await s.ask("lastWrite", { expression: "VW3300" })).text, /VW3300 was .* became/);
  assert.equal((await s.ask("lastInstructions", { count: 5 })).instructions.length, 5);
  assert.equal((await s.ask("whyNot", { condition: "M31.7" })).name, "M31.7");
  const effect = (await s.ask("effect", { expression: "VW3300 within 50ms" })).effect;
  assert.equal(effect.name, "VW3300");
  assert.ok(Array.isArray(effect.effects));
  assert.match(await s.refused("effect", { expression: "AC0" }), /for a moment only/);
});

session("what is forced holds until it is released", async (s, program) => {
  await s.begin({ program, stopOnEntry: true });
  await s.stops("stepScan", { count: 3 });
  assert.deepEqual((await s.ask("force", { values: ["VW20=7", "I0.0=1"] })).forced,
    [{ name: "I0.0", value: "1" }, { name: "VW20", value: "16#0007 (7)" }]);
  await s.stops("stepScan", { count: 3 });
  assert.equal(await s.value("VW20"), "16#0007 (7)");
  assert.match(await s.refused("force", { values: "M0.3=1" }), /cannot be forced/);
  assert.deepEqual((await s.ask("unforce", { places: "all" })).forced, []);
});

session("exception filters: a full queue, and a character that nobody wants", async (s) => {
  const program = path.join(folder, "deaf.stl");
  fs.writeFileSync(program, "LD SM0.1\nMOVB 16#09, SMB30\nLD SM0.0\nINCW VW0\nMEND\n");
  const hit = await s.begin({ program, send: "41" }, () => s.ask("setExceptionBreakpoints", { filters: ["lost"] }));
  assert.equal(hit.reason, "exception");
  assert.match(JSON.stringify(await s.ask("exceptionInfo", { threadId: 1 })), /event 8 is not attached/);
  const full = new Session();
  try {
    await full.start();
    const busy = path.join(folder, "busy.stl");
    fs.writeFileSync(busy, "LD SM0.1\nMOVB 16#09, SMB30\nATCH 0, 8\nLD SM0.0\nINCW VW0\nMEND\nINT 0\nRETI\n");
    const lost = await full.begin({ program: busy, send: "01 02 03 04 05 06" },
      () => full.ask("setExceptionBreakpoints", { filters: ["overflow"] }));
    assert.equal(lost.reason, "exception");
    assert.match(JSON.stringify(await full.ask("exceptionInfo", { threadId: 1 })), /LOST: its queue is full/);
  } finally {
    await full.end();
  }
});

session("a moment is gone to, by its time and by how long ago it was", async (s, program) => {
  await s.begin({ program, stopOnEntry: true });
  await s.stops("stepScan", { count: 20 });
  assert.match((await s.stops("goToMoment", { time: "5ms" })).description, /^at 5\.\d+ ms/);
  assert.match((await s.stops("goToMoment", { time: "-1ms" })).description, /^at 4\.\d+ ms/);
  assert.match((await s.stops("goToMoment", { time: "start" })).description, /^at 0\.000000 ms/);
  assert.match(await s.refused("goToMoment", { time: "10h" }), /nothing has run after/);
  assert.match(await s.refused("goToMoment", { time: "frob" }), /not a moment/);
});

session("interrupts are stepped to, where they begin and where they end, and back", async (s, program) => {
  await s.begin({ program, send: READ }, () => at_int_123(s));
  await s.ask("setFunctionBreakpoints", { breakpoints: [] });
  const lines = fs.readFileSync(program, "latin1").split(/\r?\n/);
  await s.stops("stepInterrupt", { end: true });
  assert.doesNotMatch((await s.frame()).name, /^INT /);
  await s.stops("stepInterrupt");
  assert.match((await s.frame()).name, /^INT /);
  await s.stops("reverseStepInterrupt", { end: true });
  assert.match(lines[(await s.frame()).line - 1], /^C?RETI/);
  await s.stops("reverseStepInterrupt");
  assert.match((await s.frame()).name, /^INT /);
});

session("a fault of the line, and what decided about the frame", async (s, program) => {
  await s.begin({ program, stopOnEntry: true });
  await s.stops("stepScan", { count: 100 });
  assert.match(await s.refused("fault", { fault: "frob" }), /frob/);
  await s.ask("fault", { fault: "flip:character=3,bit=5" });
  await s.ask("setExceptionBreakpoints", { filters: ["unanswered"] });
  await s.ask("sendFrame", { frame: READ });
  assert.equal((await s.stops("continue")).reason, "exception");
  assert.match((await s.ask("exceptionInfo", { threadId: 1 })).description, /01 03 00 0a 00 01 a4 08/);
  assert.ok((await s.ask("lastDecision", { threadId: 1 })).text.length > 0);
});

session("exception filters: errors by their codes, the watchdog, a wrong answer", async (s) => {
  const write = (name, text) => { const file = path.join(folder, name); fs.writeFileSync(file, text); return file; };
  const filter = (filterId, condition) => ({ filters: [], filterOptions: [{ filterId, ...(condition ? { condition } : {}) }] });
  const bad = write("pointer.stl", "LD SM0.0\nMOVB *VD0, VB10\nMEND\n");
  const { breakpoints } = await (async () => {
    let answer;
    const hit = await s.begin({ program: bad, set: ["VD0=16#7F000000"] }, async () => {
      await s.ask("setExceptionBreakpoints", filter("error", "9999")).then((one) => { answer = one; });
      await s.ask("setExceptionBreakpoints", filter("error", "0006"));
    });
    assert.equal(hit.reason, "exception");
    return answer;
  })();
  assert.equal(breakpoints[0].verified, false);
  const endless = new Session();
  try {
    await endless.start();
    const loop = write("endless.stl", "LBL 1\nLD SM0.0\nJMP 1\nMEND\n");
    const hit = await endless.begin({ program: loop }, () => endless.ask("setExceptionBreakpoints", filter("watchdog")));
    assert.equal(hit.reason, "exception");
    assert.match(hit.text, /0003.*it stands in front of it/);
  } finally {
    await endless.end();
  }
  const wrong = new Session();
  try {
    await wrong.start();
    const echo = write("wrong.stl", "LD SM0.1\nMOVB 9, SMB30\nATCH 0, 8\nENI\nMOVB 1, VB0\nMEND\n" +
      "INT 0\nLDB= SMB2, 8\nMOVB 16#55, VB1\nXMT VB0, 0\nRETI\n");
    const hit = await wrong.begin({ program: echo, send: READ }, () => wrong.ask("setExceptionBreakpoints", filter("wrong")));
    assert.equal(hit.reason, "exception");
    assert.match((await wrong.ask("exceptionInfo", { threadId: 1 })).description, /wrong answer/);
  } finally {
    await wrong.end();
  }
});

session("values in hex and for the clipboard, partial writes, levels of the stack", async (s, program) => {
  await s.begin({ program, send: READ }, () => at_int_123(s));
  assert.match((await s.ask("evaluate", { expression: "VW3300", format: { hex: true } })).result, /^16#[0-9A-F]{4}$/);
  assert.ok((await s.ask("evaluate", { expression: "VW3300", context: "clipboard" })).result.length > 0);
  const { stackFrames, totalFrames } = await s.ask("stackTrace", { threadId: 1, startFrame: 0, levels: 1 });
  assert.equal(stackFrames.length, 1);
  assert.equal(totalFrames, (await s.ask("stackTrace", { threadId: 1 })).stackFrames.length);
  const last = { memoryReference: "MB31", data: "AQI=" };
  assert.match(await s.refused("writeMemory", last), /run past the end/);
  assert.equal((await s.ask("writeMemory", { ...last, allowPartial: true })).bytesWritten, 1);
  const { dataId } = await s.ask("dataBreakpointInfo", { name: "VW3300" });
  await s.ask("setFunctionBreakpoints", { breakpoints: [] });
  await s.ask("setDataBreakpoints", { breakpoints: [{ dataId, accessType: "readWrite" }] });
  assert.equal((await s.stops("continue")).reason, "data breakpoint");
});

session("the STL status shows each line's last execution", async (s, program) => {
  await s.begin({ program, send: READ }, () => at_int_123(s));
  const { line, source } = await s.frame();
  await s.stops("stepIn");
  await s.stops("stepIn");
  const { lines } = await s.ask("stlStatus", { source, line, endLine: line + 1 });
  assert.equal(lines[0].line, line);
  assert.ok(lines.every((one) => /^S0=[01]/.test(one.text)));
});

session("a session restarts, terminates and disconnects", async (s, program) => {
  await s.begin({ program, stopOnEntry: true });
  await s.stops("stepScan", { count: 5 });
  assert.equal((await s.stops("restart")).reason, "entry");
  const terminated = s.client.waitForEvent("terminated");
  await Promise.all([terminated, s.ask("terminate")]);
  assert.equal(s.events.find((one) => one.event === "exited").body.exitCode, 0);
  await s.disconnect();
});

session("a long reversal can be cancelled and stands where it began", async (s, program) => {
  await s.begin({ program, stopOnEntry: true });
  await s.stops("stepScan", { count: 2000 });
  const there = await s.state();
  const stopped = s.client.waitForEvent("stopped");
  const reversal = s.ask("reverseContinue", { threadId: 1 });
  const cancelled = s.ask("cancel", { progressId: "any" });
  const [event] = await Promise.all([stopped, reversal, cancelled]);
  if (event.body.reason === "pause") assert.equal(await s.state(), there);
  else assert.match(event.body.description, /oldest moment/); // it was faster
});

// --- TCP ---

test("on a TCP port clients attach one after the other to a PLC that stays", async () => {
  const server = spawn(S7200, ["dap", "--listen", "0", SLAVE, "--set", "VW20=7"], { stdio: ["ignore", "ignore", "pipe"] });
  try {
    const [, port, token] = await new Promise((resolve) =>
      server.stderr.once("data", (text) => resolve(/:(\d+), for clients with "token": "(\w+)"/.exec(text))));
    const first = new Session();
    await first.start(+port);
    await first.begin({ token }, undefined, "attach");
    await first.stops("stepScan", { count: 3 });
    const there = await first.state();
    await first.disconnect();
    await first.end();
    const second = new Session();
    await second.start(+port);
    await second.begin({ token }, undefined, "attach");
    assert.equal(await second.state(), there);
    assert.equal(await second.value("VW20"), "16#0007 (7)");
    await second.stops("reverseStepScan");
    await second.disconnect();
    await second.end();
    const third = new Session();
    await third.start(+port);
    await third.begin({ program: SLAVE, stopOnEntry: true, token });
    assert.equal(await third.value("VW20"), "16#0000 (0)");
    await third.end();
  } finally {
    server.kill("SIGINT");
    assert.equal(await new Promise((resolve) => server.once("exit", resolve)), 0);
  }
});

test("without a PLC to attach to, attach says how to get one", async () => {
  const s = new Session();
  await s.start();
  assert.match(await s.refused("attach", {}), /s7200 dap --listen 4711/);
  await s.end();
});

// --- a master outside ---

test("a launch with a bridge runs as fast as the clock and says where it listens", async () => {
  const s = new Session();
  await s.start();
  const output = s.client.waitForEvent("output");
  const initialized = s.client.waitForEvent("initialized");
  await Promise.all([initialized, s.ask("launch", { program: SLAVE, modbusTcp: "0" })]);
  assert.match((await output).body.output, /listening on 127.0.0.1:\d+/);
  assert.match(s.printed, /their time-outs are their own affair/);
  await s.ask("configurationDone");
  assert.equal((await s.stops("pause")).reason, "pause");
  await s.end();
});

test("what a master on a bridge asked can be played again from the beginning", async () => {
  const s = new Session();
  await s.start();
  const output = s.client.waitForEvent("output");
  const initialized = s.client.waitForEvent("initialized");
  await Promise.all([initialized, s.ask("launch", { program: SLAVE, modbusTcp: "0" })]);
  const [, port] = (await output).body.output.match(/listening on 127.0.0.1:(\d+)/);
  await s.ask("configurationDone");
  const master = net.connect(Number(port), "127.0.0.1");
  master.write(Buffer.from("0001000000060103000a0001", "hex"));
  await new Promise((answered) => master.once("data", answered));
  await s.stops("pause");
  master.destroy();
  assert.match((await s.ask("lastWrite", { expression: "VW4000" })).text, /has written VW4000/);
  await s.end();
});

// --- the worked example of the README ---

const CAUSES = [
  { name: "a wrong CRC", frame: "01 03 00 0a 00 01 00 00",
    slave: [/^SBR 51/, /JMP\s+255\s+\/\/ a disturbed/, /LDW= +AC0, 0 +S0=0/], tip: [/^SBR 51/, /JMP\s+255/, /LDW=\s+0, AC2 +S0=0/] },
  { name: "another station", frame: "02 03 00 0a 00 01 crc",
    slave: [/^INT 122/, /CRETI/, /LDB= +SMB2, VB4095 +S0=0 SMB2=16#02 VB4095=16#01/],
    tip: [/^INT 122/, /CRETI/, /LDB= +SMB2, VB4095 +S0=0 SMB2=16#02 VB4095=16#01/] },
  { name: "a parity error", frame: "01 03p 00 0a 00 01 crc",
    slave: [/^INT 123/, /CRETI/, /LDN +SM3\.0 +S0=0 SM3\.0=1/], tip: [/^INT 123/, /ATCH\s+120, 10/, /LD +SM3\.0 +S0=1 SM3\.0=1/] },
  { name: "too short", frame: "01 03 00",
    slave: [/^SBR 51/, /JMP\s+255\s+\/\/ fewer are not/, /LDW<= +VW3300, 3 +S0=1 VW3300=16#0003/],
    tip: [/^SBR 51/, /JMP\s+255/, /LDW=\s+0, AC2 +S0=0/] },
];

// What is shown of a session: requests, stops, and the line where it stands.
class Transcript {
  constructor() { this.lines = []; }
  log(kind, ...what) {
    if (kind === "request" && what[0] !== "stackTrace") {
      const { threadId, ...args } = what[1];
      this.lines.push(`-> ${what[0]} ${JSON.stringify(args, (key, value) => (key === "program" ? path.basename(value) : value))}`);
    }
    if (kind === "said") this.lines.push(...what[0].split("\n").map((line) => `<- ${line}`));
    if (kind === "stopped") this.lines.push(`<- stopped: ${[...new Set([what[0].reason, what[0].description])].join(", ")}`);
    if (kind === "frame") this.lines.push(`   ${what[0].name}, ${what[0].source.name}:${what[0].line}`);
  }
}

async function find_cause(program, kind, cause, transcript) {
  const s = new Session((...what) => transcript.log(...what));
  try {
    await s.start();
    const hit = await s.begin({ program, send: cause.frame, sendAfter: "2s" },
      () => s.ask("setExceptionBreakpoints", { filters: ["unanswered"] }));
    assert.equal(hit.reason, "exception");
    await s.stops("reverseToLastWrite", { expression: "event 8" });
    assert.match(s.printed, /ATCH: INT 122 to event 8/);
    await s.stops("reverseToLastWrite", { expression: "event 8" });
    assert.match(s.printed, /ATCH: INT 121 to event 8/);
    await s.stops("reverseToLastDecision");
    const [routine, instruction, reason] = cause[kind];
    const frame = await s.frame();
    assert.match(frame.name, routine);
    assert.match(fs.readFileSync(program, "latin1").split(/\r?\n/)[frame.line - 1], instruction);
    const { instructions } = await s.ask("lastInstructions", { count: 9 });
    assert.ok(instructions.some((one) => reason.test(one.text)));
    const decided = instructions.filter((one) => reason.test(one.text)).pop();
    transcript.lines.push(`   ${decided.text}`);
  } finally {
    await s.end();
  }
}

for (const { name: of, program } of PROGRAMS)
  test(`from an unanswered frame back to the instruction that dropped it (${of})`, async () => {
    const transcript = new Transcript();
    const kind = of === "the tip" ? "tip" : "slave";
    for (const cause of CAUSES) {
      transcript.lines.push("", cause.name);
      await find_cause(program, kind, cause, transcript);
    }
    if (kind === "tip") return; // third-party text is not kept here
    const file = path.join(SOURCE, "tests/dap/unanswered_frame.transcript");
    const text = transcript.lines.slice(1).join("\n") + "\n";
    if (process.env.WRITE) fs.writeFileSync(file, text);
    assert.equal(text, fs.readFileSync(file, "utf8"));
  });

test("the README lists every request that the protocol has not", () => {
  const words = (text, pattern) => [...text.matchAll(pattern)].map(([, word]) => word);
  const source = (file) => fs.readFileSync(path.join(SOURCE, "tools/faces/dap", file), "utf8");
  const of_protocol = words(fs.readFileSync(require.resolve("@vscode/debugprotocol/lib/debugProtocol.d.ts"), "utf8"), /command: '(\w+)'/g);
  const files = ["life", "breakpoints", "steps", "seeing", "memory", "commands"].map((file) => source(`requests/${file}.cpp`));
  const commands = words(files[5], /^ {4}\{"(\w+)", "[\w ]+", "/gm);
  assert.ok(commands.includes("sendFrame"));
  const offered = files.flatMap((text) => words(text.split("_requests() {")[1], /\{"(\w+)",\s+[a-z_]+\b/g)).concat(commands);
  const rows = /\| request \|[^]*?\n\n/.exec(source("README.md"))[0].split("\n").slice(2);
  const listed = rows.flatMap((row) => words(row.split("|")[1] || "", /`(\w+)`/g));
  assert.ok(of_protocol.includes("stepIn") && offered.includes("stepIn"));
  assert.deepEqual(listed.sort(), offered.filter((one) => !of_protocol.includes(one)).sort());
});

test("the session in the README is one of the transcripts", () => {
  const shown = /```text\n(-> launch[^]*?)```/.exec(fs.readFileSync(path.join(SOURCE, "docs/debugger.md"), "utf8"))[1];
  assert.ok(fs.readFileSync(path.join(SOURCE, "tests/dap/unanswered_frame.transcript"), "utf8").includes(shown));
});
