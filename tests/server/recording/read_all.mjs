// Reads a recording with the library of MCAP's makers, by its index and as a stream, and prints
// what it found. Node's path has to lead to @mcap/core.

import { createRequire } from "node:module";
import { open, readFile } from "node:fs/promises";
import { zstdDecompressSync } from "node:zlib";

const require = createRequire(`${process.argv[3]}/`);
const { McapIndexedReader, McapStreamReader } = require("@mcap/core");
const decompressHandlers = { zstd: (bytes) => new Uint8Array(zstdDecompressSync(bytes)) };

const file = await open(process.argv[2]);
const readable = {
  size: async () => BigInt((await file.stat()).size),
  read: async (offset, size) => {
    const bytes = new Uint8Array(Number(size));
    await file.read(bytes, 0, Number(size), Number(offset));
    return bytes;
  },
};

const topics = {};
const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
for await (const { channelId } of reader.readMessages({ validateCrcs: true })) {
  const channel = reader.channelsById.get(channelId);
  const schema = reader.schemasById.get(channel.schemaId);
  topics[channel.topic] ??= {
    messages: 0,
    encoding: channel.messageEncoding,
    schema: schema.encoding && JSON.parse(new TextDecoder().decode(schema.data) || "{}").type,
  };
  topics[channel.topic].messages++;
}
const attached = [];
for await (const { name } of reader.readAttachments({ validateCrcs: true })) attached.push(name);
await file.close();

const stream = new McapStreamReader({ decompressHandlers, validateCrcs: true });
stream.append(await readFile(process.argv[2]));
let streamed = 0;
for (let record; (record = stream.nextRecord()); ) if (record.type === "Message") streamed++;

console.log(JSON.stringify({ topics, attached, streamed, whole: stream.done() }));
