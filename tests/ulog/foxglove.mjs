// Prints all that @foxglove/ulog reads of a ULog, a JSON object a line, in no particular order.
// print.cpp prints the same of attest's reader; compare.py compares the two.
//
//     node foxglove.mjs FILE
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";

const require = createRequire(import.meta.url);
const { ULog, MessageType } = require("@foxglove/ulog");
const { parseFieldDefinition } = require("@foxglove/ulog/dist/definition.js");
const { parseBasicFieldValue } = require("@foxglove/ulog/dist/parse.js");

const HEADER = 16;
const HEAD = 3; // of a message
const OFFSETS = HEADER + HEAD + 16; // of the appended data, in the flag bits message

// Where the last complete message of bytes[begin, end) ends.
function completeEnd(bytes, begin, end) {
  for (;;) {
    const next = begin + HEAD + (begin + HEAD <= end ? bytes.readUInt16LE(begin) : 0);
    if (next > end) return begin;
    begin = next;
  }
}

// The package does not read appended data. So they are moved to where the log ends, without a
// message that is cut off there.
function withoutOffsets(bytes) {
  if (bytes[HEADER + 2] !== MessageType.FlagBits) return bytes;
  const offsets = [0, 8, 16].map((at) => Number(bytes.readBigUInt64LE(OFFSETS + at)));
  const bounds = [HEADER, ...offsets.filter((offset) => offset > 0), bytes.length];
  const parts = [bytes.subarray(0, HEADER)];
  for (let i = 0; i + 1 < bounds.length; ++i) {
    parts.push(bytes.subarray(bounds[i], completeEnd(bytes, bounds[i], bounds[i + 1])));
  }
  return Buffer.concat(parts).fill(0, OFFSETS, OFFSETS + 24);
}

class InMemory {
  constructor(bytes) {
    this.bytes = bytes;
  }
  async open() {
    return this.bytes.length;
  }
  async read(offset, length) {
    return new Uint8Array(this.bytes.subarray(offset, offset + length));
  }
  size() {
    return this.bytes.length;
  }
}

// What JSON has no number for becomes text.
function plain(value) {
  if (Array.isArray(value)) return value.map(plain);
  if (typeof value === "bigint") return String(value);
  if (Object.is(value, -0)) return "-0";
  if (typeof value === "number" && !Number.isFinite(value)) return String(value);
  return value;
}

// Nested objects as one with paths: "a.b[2].c".
function flatten(value, path, fields) {
  if (Array.isArray(value) && typeof value[0] === "object") {
    value.forEach((each, i) => flatten(each, `${path}[${i}]`, fields));
  } else if (typeof value === "object" && !Array.isArray(value)) {
    for (const [name, each] of Object.entries(value)) {
      flatten(each, path === "" ? name : `${path}.${name}`, fields);
    }
  } else {
    fields[path] = plain(value);
  }
  return fields;
}

function print(object) {
  console.log(JSON.stringify(object));
}

function printDefinitions({ version, timestamp, information, parameters, definitions }) {
  print({ version, start_us: String(timestamp) });
  for (const [key, value] of information) {
    // The package joins the values of multi information messages, and names them by type and name.
    print(key.includes(" ") ? { multi: key, values: plain(value) } : { info: key, value: plain(value) });
  }
  for (const [name, { value, defaultTypes }] of parameters) {
    print({ parameter: name, value: plain(value), defaults: defaultTypes });
  }
  for (const { name, fields } of definitions.values()) {
    print({ format: name, fields: fields.map((each) => [each.type, each.arrayLength ?? 0, each.name]) });
  }
}

// PX4 writes empty texts as `char[0]`, a definition that the package does not read.
function isEmptyText(key) {
  return key.startsWith("char[0] ");
}

function keyValue(message) {
  if (isEmptyText(message.key)) return "";
  const view = new DataView(message.value.buffer, message.value.byteOffset, message.value.byteLength);
  return plain(parseBasicFieldValue(parseFieldDefinition(message.key), view));
}

function printMessage(log, message) {
  switch (message.type) {
    case MessageType.Data: {
      const { name, multiId } = log.subscriptions.get(message.msgId);
      return print({ data: name, multi_id: multiId, fields: flatten(message.value, "", {}) });
    }
    case MessageType.AddLogged:
      return print({ subscribe: message.msgId, multi_id: message.multiId, topic: message.messageName });
    case MessageType.RemoveLogged:
      return print({ end: message.msgId });
    case MessageType.Log:
    case MessageType.LogTagged: {
      const { logLevel, tag, timestamp, message: text } = message;
      return print({ level: logLevel, tag: tag ?? -1, timestamp: String(timestamp), text });
    }
    case MessageType.Dropout:
      return print({ dropout_ms: message.duration });
    case MessageType.Synchronization:
      return print({ sync: true });
    case MessageType.Unknown:
      return undefined;
    default:
      return print({ later: String.fromCharCode(message.type), key: message.key, value: keyValue(message) });
  }
}

const log = new ULog(new InMemory(withoutOffsets(readFileSync(process.argv[2]))));
await log.open();
printDefinitions(log.header);
for await (const message of log.readMessages()) printMessage(log, message);
