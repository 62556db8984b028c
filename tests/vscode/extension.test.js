// The extension for VS Code: its grammar, what it says in package.json, its package, and its code with a stand-in for VS Code.
"use strict";
const { test } = require("node:test");
const assert = require("node:assert/strict");
const { execFileSync } = require("node:child_process");
const fs = require("node:fs");
const Module = require("node:module");
const os = require("node:os");
const path = require("node:path");

const { S7200, SOURCE, VSIX } = process.env;
const FOLDER = path.join(SOURCE, "tools/vscode-s7200");
const manifest = JSON.parse(fs.readFileSync(path.join(FOLDER, "package.json"), "utf8"));
const s7200 = (...args) => execFileSync(S7200, args, { encoding: "utf8" });

// --- the grammar ---

async function load_grammar() {
  const oniguruma = require("vscode-oniguruma");
  const { Registry, parseRawGrammar } = require("vscode-textmate");
  await oniguruma.loadWASM(fs.readFileSync(require.resolve("vscode-oniguruma/release/onig.wasm")).buffer);
  const file = path.join(FOLDER, "syntaxes/s7200-stl.tmLanguage.json");
  const registry = new Registry({
    onigLib: Promise.resolve({
      createOnigScanner: (patterns) => new oniguruma.OnigScanner(patterns), createOnigString: (text) => new oniguruma.OnigString(text),
    }),
    loadGrammar: async () => parseRawGrammar(fs.readFileSync(file, "utf8"), file),
  });
  return registry.loadGrammar("source.s7200-stl");
}

const grammar = load_grammar();

// {piece of the line: its scope}
async function scopes(line) {
  const found = {};
  for (const token of (await grammar).tokenizeLine(line, null).tokens) {
    const text = line.slice(token.startIndex, token.endIndex).trim();
    if (text) found[text] = token.scopes.at(-1).replace(/\.s7200$/, "");
  }
  return found;
}

test("contacts, boxes, control and operands have scopes of their own", async () => {
  assert.deepEqual(await scopes("LDW>=   VW3300, 16#0A  // enough?"), {
    "LDW>=": "keyword.operator.logical", VW3300: "variable.other.memory", ",": "source.s7200-stl", "16#0A": "constant.numeric.hex",
    "// enough?": "comment.line.double-slash",
  });
  assert.deepEqual(await scopes("MOVB    *VD3302, SMB2"), {
    MOVB: "support.function", "*": "keyword.operator.pointer", VD3302: "variable.other.memory", ",": "source.s7200-stl",
    SMB2: "variable.other.memory",
  });
  assert.deepEqual(await scopes("MOVR 1.5, AC0"), {
    MOVR: "support.function", 1.5: "constant.numeric.real", ",": "source.s7200-stl", AC0: "variable.language.accumulator",
  });
  assert.deepEqual(await scopes("= Q0.0"), { "=": "keyword.operator.logical", "Q0.0": "constant.language.bit" });
  assert.deepEqual(await scopes("TON T37, 100"),
    { TON: "support.function", T37: "variable.other.element", ",": "source.s7200-stl", 100: "constant.numeric.decimal" });
});

test("networks, routines and blocks are headings", async () => {
  assert.deepEqual(await scopes("NETWORK 12"), { NETWORK: "keyword.other.network", 12: "entity.name.section" });
  assert.deepEqual(await scopes("SBR 51"), { SBR: "keyword.control", 51: "entity.name.function" });
  assert.deepEqual(await scopes("INT     123"), { INT: "keyword.control", 123: "entity.name.function" });
  assert.equal((await scopes("END_SUBROUTINE_BLOCK")).END_SUBROUTINE_BLOCK, "keyword.other.block");
  assert.equal((await scopes("  creti  // out")).creti, "keyword.control");
});

test("what is not an instruction is not coloured as one", async () => {
  assert.equal((await scopes("FROB VB0")).FROB, "source.s7200-stl");
  assert.equal((await scopes("MOVBX VB0")).MOVBX, "source.s7200-stl");
  assert.equal((await scopes("// MOVB 1, VB0"))["// MOVB 1, VB0"], "comment.line.double-slash");
});

test("every instruction of every one of our programs is coloured", async () => {
  for (const name of fs.readdirSync(path.join(SOURCE, "stl_programs")).filter((one) => one.endsWith(".stl")))
    for (const line of fs.readFileSync(path.join(SOURCE, "stl_programs", name), "utf8").split("\n")) {
      const mnemonic = /^\s*([^\s/]+)/.exec(line);
      if (!mnemonic) continue;
      const scope = (await scopes(line))[mnemonic[1]] || Object.values(await scopes(line))[0];
      assert.match(scope, /^(keyword|support)/, `${name}: ${line}`);
    }
});

// --- package.json ---

test("each attribute of a launch is an option of debug, or one of the session", () => {
  const help = s7200("debug", "--help-all");
  const readme = fs.readFileSync(path.join(SOURCE, "tools/faces/dap/README.md"), "utf8");
  for (const name of Object.keys(manifest.contributes.debuggers[0].configurationAttributes.launch.properties)) {
    const option = "--" + name.replace(/[A-Z]/g, (letter) => "-" + letter.toLowerCase());
    assert.ok(help.includes(`  ${option} `) || readme.includes(`\`${name}\``), name);
  }
});

test("each option of debug is an attribute of a launch, but for where commands come from, which scenario, and a report", () => {
  const { properties } = manifest.contributes.debuggers[0].configurationAttributes.launch;
  for (const [, option] of s7200("debug", "--help-all").matchAll(/^ +(?:-.,)?--([a-z-]+) /gm)) {
    if (["help", "help-all", "commands", "execute", "interactive", "only", "target", "report"].includes(option)) continue;
    assert.ok(option.replace(/-[a-z]/g, (letter) => letter[1].toUpperCase()) in properties, option);
  }
});

test("it has the version and the licence of the command", () => {
  assert.equal(`s7200 ${manifest.version}\n`, s7200("--version"));
  assert.match(fs.readFileSync(path.join(SOURCE, "LICENSE"), "utf8"), new RegExp(manifest.license));
});

test("the problem matcher reads what check prints", () => {
  const file = path.join(SOURCE, "tests/exports/broken.awl");
  let printed = "";
  try {
    s7200("check", file);
  } catch (error) {
    printed = error.stderr + error.stdout;
  }
  const { regexp } = manifest.contributes.problemMatchers[0].pattern;
  const problems = printed.split("\n").map((line) => new RegExp(regexp).exec(line)).filter(Boolean);
  assert.ok(problems.length > 0, printed);
  assert.equal(problems[0][1], file);
  assert.ok(Number(problems[0][2]) > 0);
});

test("a launch and an attach can be begun from snippets, with attributes that there are", () => {
  const { configurationSnippets, configurationAttributes } = manifest.contributes.debuggers[0];
  const known = ["type", "request", "name"];
  for (const { body, label } of configurationSnippets)
    for (const name of Object.keys(body))
      assert.ok(known.includes(name) || name in configurationAttributes[body.request].properties, `${label}: ${name}`);
  assert.deepEqual([...new Set(configurationSnippets.map(({ body }) => body.request))].sort(), ["attach", "launch"]);
});

test("F5 without a launch.json debugs the program in the editor", () => {
  const { configurations, window, shown } = stand_in();
  assert.equal(configurations.resolveDebugConfiguration(undefined, {}), undefined, "nothing is open");
  assert.deepEqual(shown, ["Open the STL program that is to be debugged."]);
  for (const languageId of ["s7200-stl", "plaintext"]) {
    window.activeTextEditor = { document: { languageId, uri: { fsPath: "/a.stl" } } };
    assert.equal(configurations.resolveDebugConfiguration(undefined, {}).program, "/a.stl", languageId);
  }
});

// A new launch.json gets both the initial configurations of package.json and those of a provider for them.
test("a configuration is offered once in a new launch.json, and once without one", () => {
  const { configurations, offered_when } = stand_in();
  assert.equal(manifest.contributes.debuggers[0].initialConfigurations.length, 1);
  assert.equal(offered_when, "dynamic");
  assert.deepEqual(configurations.provideDebugConfigurations(), manifest.contributes.debuggers[0].initialConfigurations);
});

test("words under the cursor are operands", () => {
  const { wordPattern } = JSON.parse(fs.readFileSync(path.join(FOLDER, "language-configuration.json"), "utf8"));
  for (const word of ["VW3300", "*VD100", "M31.7", "AC0", "16#0A", '"Pump 1"'])
    assert.equal(new RegExp(wordPattern).exec(`MOVW ${word}, VW0`.slice(5))[0], word);
});

test("the snippets are programs", () => {
  const snippets = JSON.parse(fs.readFileSync(path.join(FOLDER, "snippets/s7200-stl.json"), "utf8"));
  for (const [name, { body }] of Object.entries(snippets)) {
    const lines = body.join("\n").replace(/\$\{\d+:([^}]*)\}/g, "$1").replace(/\$0/g, "");
    const main = /^(SBR|INT)/.test(lines) ? `MEND\n${lines}` : `${lines}\nMEND`;
    const routines = (/CALL +0/.test(lines) ? "\nSBR 0\nRET" : "") + (/ATCH +0/.test(lines) ? "\nINT 0\nRETI" : "");
    const file = path.join(fs.mkdtempSync(path.join(os.tmpdir(), "s7200-vscode-")), "snippet.stl");
    fs.writeFileSync(file, main + routines + "\n");
    assert.doesNotThrow(() => execFileSync(S7200, ["check", file], { stdio: "pipe" }), name);
    fs.rmSync(path.dirname(file), { recursive: true });
  }
});

// --- the code ---

function stand_in() {
  const settings = { path: S7200, status: true };
  const registered = { commands: {}, asked: [], shown: [], settings };
  const show = (message) => { registered.shown.push(message); };
  const window = { showInputBox: async () => "VW3300", showErrorMessage: show, showInformationMessage: show };
  registered.window = window;
  const session = {
    type: "s7200",
    customRequest: async (request, args) => {
      registered.asked.push([request, args]);
      return request === "stlStatus" ? { lines: [{ line: 3, powerFlow: true, text: "S0=1 VB0=16#05" }] } : { text: "said" };
    },
  };
  registered.session = session;
  const vscode = {
    registered,
    workspace: { getConfiguration: () => ({ get: (key) => settings[key] }) },
    window,
    debug: {
      activeDebugConsole: { appendLine: (text) => { registered.printed = text; } },
      activeDebugSession: session,
      registerDebugAdapterDescriptorFactory: (type, factory) => { registered.factory = factory; },
      registerDebugConfigurationProvider: (type, provider, when) => {
        registered.configurations = provider;
        registered.offered_when = when;
      },
    },
    languages: {
      registerInlineValuesProvider: (where, provider) => { registered.status = provider; },
      registerHoverProvider: (where, provider) => { registered.hover = provider; },
      registerEvaluatableExpressionProvider: (where, provider) => { registered.operands = provider; },
    },
    tasks: { registerTaskProvider: (type, provider) => { registered.tasks = provider; } },
    commands: { registerCommand: (name, run) => { registered.commands[name] = run; } },
    DebugAdapterExecutable: class { constructor(...args) { this.args = args; } },
    DebugAdapterServer: class { constructor(...args) { this.args = args; } },
    EvaluatableExpression: class { constructor(range) { this.range = range; } },
    Hover: class { constructor(...args) { this.args = args; } },
    InlineValueText: class { constructor(...args) { this.args = args; } },
    ProcessExecution: class { constructor(...args) { this.args = args; } },
    Task: class { constructor(...args) { this.args = args; } },
    DebugConfigurationProviderTriggerKind: { Initial: "initial", Dynamic: "dynamic" },
    TaskScope: { Workspace: 2 }, TaskGroup: { Build: "build" },
  };
  const load = Module._load;
  Module._load = (name, ...rest) => (name === "vscode" ? vscode : load(name, ...rest));
  try {
    delete require.cache[path.join(FOLDER, "extension.js")];
    require(path.join(FOLDER, "extension.js")).activate({ subscriptions: [] });
  } finally {
    Module._load = load;
  }
  return registered;
}

test("the commands have a request for each thing that the protocol has no button for", () => {
  const commands = manifest.contributes.commands.map((one) => one.command.replace("s7200.", ""));
  for (const request of ["stepInterrupt", "reverseStepInterrupt", "fault", "lastWrite", "lastDecision"]) assert.ok(commands.includes(request), request);
});

test("every command of package.json does what the session offers", async () => {
  const registered = stand_in();
  const commands = manifest.contributes.commands.map((one) => one.command);
  assert.deepEqual(Object.keys(registered.commands).sort(), commands.sort());
  for (const { command, enablement } of manifest.contributes.commands) assert.equal(enablement, "debugType == s7200", command);
  const source = (file) => fs.readFileSync(path.join(SOURCE, "tools/faces/dap/requests", file), "utf8");
  const offered = source("steps.cpp") + source("seeing.cpp") + source("commands.cpp");
  for (const [name, run] of Object.entries(registered.commands)) {
    await run();
    const [request, args] = registered.asked.pop();
    assert.equal(`s7200.${request}`, name);
    assert.ok(offered.includes(`{"${request}", `), request);
    assert.equal(args.threadId, 1);
  }
  assert.equal(registered.printed, "said");
});

test("the adapter is the command, or a port to attach to", async () => {
  const { factory } = stand_in();
  const adapter = async (configuration) => (await factory.createDebugAdapterDescriptor({ configuration })).args;
  assert.deepEqual(await adapter({ request: "launch" }), [S7200, ["dap"]]);
  assert.deepEqual(await adapter({ request: "attach", port: 4711 }), [4711, "127.0.0.1"]);
});

test("an attach has the token of the server, and asks for one that is missing", async () => {
  const { configurations, window } = stand_in();
  const resolved = (more) => configurations.resolveDebugConfiguration(undefined, { type: "s7200", request: "attach", port: 4711, ...more });
  assert.equal((await resolved({ token: "of launch.json" })).token, "of launch.json");
  window.showInputBox = async () => " 5b8c \n";
  assert.equal((await resolved({})).token, "5b8c");
  window.showInputBox = async () => undefined;
  assert.equal(await resolved({}), undefined, "no session without one");
  assert.equal(configurations.resolveDebugConfiguration(undefined, { type: "s7200", request: "launch", program: "a.stl" }).token, undefined);
});

test("a launch says that the command cannot be run", async () => {
  const { factory, settings } = stand_in();
  settings.path = "no-such-s7200";
  await assert.rejects(factory.createDebugAdapterDescriptor({ configuration: { request: "launch" } }),
    /^Error: Cannot run 'no-such-s7200' \(spawn no-such-s7200 ENOENT\)\. Put s7200 in the path, or say where it is in the setting/);
});

test("the STL status stands beside its lines", async () => {
  const { status, asked } = stand_in();
  const document = { uri: { fsPath: "/a.stl" }, lineAt: (line) => ({ range: `line ${line}` }) };
  const values = await status.provideInlineValues(document, { start: { line: 0 }, end: { line: 9 } }, {});
  assert.deepEqual(values.map((one) => one.args), [["line 2", "S0=1 VB0=16#05"]]);
  assert.deepEqual(asked, [["stlStatus", { source: { path: "/a.stl" }, line: 1, endLine: 10 }]]);
});

test("pointing at a line says which power flow S0 is", async () => {
  const { hover, asked } = stand_in();
  const { args: [lines] } = await hover.provideHover({ uri: { fsPath: "/a.stl" } }, { line: 2 });
  assert.equal(lines[0], "S0=1 VB0=16#05");
  assert.match(lines[1], /^S0 is the power flow behind a contact, and in front of a coil, box or call/);
  assert.deepEqual(asked, [["stlStatus", { source: { path: "/a.stl" }, line: 3, endLine: 3 }]]);
});

// As VS Code finds a word: the match that the position is in.
function document_of(line) {
  return {
    getWordRangeAtPosition: ({ character }, regexp) =>
      [...line.matchAll(new RegExp(regexp, "g"))].find((one) => one.index <= character && character <= one.index + one[0].length)?.[0],
  };
}

test("pointing at an operand asks for the value of all of it", () => {
  const { operands } = stand_in();
  for (const operand of ["M31.7", "VW3300", "*VD100", "AC0", '"Pump 1"', "Pump"]) {
    const asked = operands.provideEvaluatableExpression(document_of(`MOVW ${operand}, 5`), { character: 7 });
    assert.equal(asked.range, operand);
  }
  assert.equal(operands.provideEvaluatableExpression(document_of("MOVW VW0, 5"), { character: 10 }), undefined);
});

test("the last instructions are lines with their times", async () => {
  const registered = stand_in();
  const { commands, session } = registered;
  session.customRequest = async (request) => request === "lastInstructions" && { instructions: [{ time: "1.500000", text: "line 2  INCW" }] };
  await commands["s7200.lastInstructions"]();
  assert.equal(registered.printed, "       1.500000  line 2  INCW");
});

test("a refused command is shown once, by VS Code", async () => {
  const { commands, session, shown } = stand_in();
  session.customRequest = async () => { throw new Error("refused"); };
  await commands["s7200.timeline"]();
  assert.deepEqual(shown, []);
});

test("tasks run the command with the problem matcher", () => {
  const [check] = stand_in().tasks.provideTasks();
  assert.deepEqual(check.args[4].args, [S7200, ["check", "${file}"]]);
  assert.equal(check.args[5], "$s7200");
});

test("a task gives full paths, as the problem matcher wants them", () => {
  const { tasks } = stand_in();
  const file_of = (file) => tasks.resolveTask({ definition: { type: "s7200", verb: "check", file } }).args[4].args[1][1];
  assert.equal(manifest.contributes.problemMatchers[0].fileLocation, "absolute");
  assert.equal(file_of("a.stl"), "${workspaceFolder}/a.stl");
  assert.equal(file_of("/b/a.stl"), "/b/a.stl");
  assert.equal(file_of("${file}"), "${file}");
});

// --- the package ---

test("the package has what VS Code needs and nothing else", () => {
  const files = execFileSync("python3", ["-c", "import sys, zipfile; print('\\n'.join(sorted(zipfile.ZipFile(sys.argv[1]).namelist())))", VSIX],
    { encoding: "utf8" }).trim().split("\n");
  assert.deepEqual(files, ["[Content_Types].xml", "extension.vsixmanifest", "extension/LICENSE.txt", "extension/extension.js",
    "extension/language-configuration.json", "extension/package.json", "extension/readme.md", "extension/snippets/s7200-stl.json",
    "extension/syntaxes/s7200-stl.tmLanguage.json"]);
  const inside = execFileSync("python3", ["-c", "import sys, zipfile; print(zipfile.ZipFile(sys.argv[1]).read('extension/package.json').decode())", VSIX],
    { encoding: "utf8" });
  assert.equal(JSON.parse(inside).contributes.debuggers[0].type, "s7200");
});
