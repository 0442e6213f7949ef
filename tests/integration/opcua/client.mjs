// A client of OPC UA in a process of its own; one JSON document a line on standard output.
//   node client.mjs endpoints URL               what the server offers, asked without a session
//   node client.mjs session URL MODE POLICY FOLDER    whether a session can be made; FOLDER: for the client's certificate
//   node client.mjs browse URL                  every node below the devices, with its references, attributes and value
//   node client.mjs write URL                   tries to write every variable and to call what can be called
//   node client.mjs abandon URL COUNT           activates sessions, each of a client of its own, and ends without closing them
//   node client.mjs watch URL ID...             a line for each notification of these variables, until it is ended
import opcua from "node-opcua";

const {AttributeIds, BrowseDirection, MessageSecurityMode, NodeClass, OPCUACertificateManager, OPCUAClient, SecurityPolicy} = opcua;
const [, , what, url, ...more] = process.argv;
const kDevices = "http://opcfoundation.org/UA/DI/";
opcua.setLogLevel(opcua.LogLevel.Error);

// Resolves when it is written, which a pipe may take its time for.
function say(document) {
  const line = JSON.stringify(document, (_, value) => (typeof value === "bigint" ? Number(value) : value));
  return new Promise((resolve) => process.stdout.write(`${line}\n`, resolve));
}

async function with_session(options, body) {
  const client = OPCUAClient.create({endpointMustExist: false, connectionStrategy: {maxRetry: 20, initialDelay: 100, maxDelay: 500}, ...options});
  await client.connect(url);
  const session = await client.createSession();
  try {
    return await body(session);
  } finally {
    await session.close();
    await client.disconnect();
  }
}

const kForward = {browseDirection: BrowseDirection.Forward, includeSubtypes: true, nodeClassMask: 0, resultMask: 63};

async function references(session, id) {
  const answer = await session.browse({...kForward, nodeId: id, referenceTypeId: "References"});
  const found = [...answer.references];
  for (let rest = answer.continuationPoint; rest?.length;) {
    const next = await session.browseNext(rest, false);
    found.push(...next.references);
    rest = next.continuationPoint;
  }
  return found;
}

// Names with the URI of their namespace instead of its number, which the server chooses.
class Names {
  constructor(uris) {
    this.uris_ = uris;
  }
  node(id) {
    const text = id.toString();
    return `${this.uris_[id.namespace]}|${text.replace(/^ns=\d+;/, "")}`;
  }
  browse(name) {
    return `${this.uris_[name.namespaceIndex]}|${name.name}`;
  }
}

async function described(session, names, reference) {
  const id = reference.nodeId;
  const node = {id: id.toString(), name: names.browse(reference.browseName), kind: NodeClass[reference.nodeClass], type: null, children: []};
  for (const one of await references(session, id)) {
    if (one.referenceTypeId.toString() === "ns=0;i=40") node.type = names.node(one.nodeId);
    else node.children.push({by: names.node(one.referenceTypeId), id: one.nodeId.toString()});
  }
  if (reference.nodeClass === NodeClass.Variable) {
    const [value, data_type, rank, access] = await session.read([AttributeIds.Value, AttributeIds.DataType, AttributeIds.ValueRank, AttributeIds.AccessLevel].map((attributeId) => ({nodeId: id, attributeId})));
    Object.assign(node, {value: value.value.value, status: value.statusCode.name, source: value.sourceTimestamp, data_type: names.node(data_type.value.value), rank: rank.value.value, access: access.value.value});
  }
  return node;
}

// Every node that can be reached from the devices by a hierarchical reference, once.
async function all_nodes(session) {
  const uris = await session.readNamespaceArray();
  const names = new Names(uris);
  const nodes = new Map();
  const open = [`ns=${uris.indexOf(kDevices)};i=5001`];
  while (open.length > 0) {
    const answer = await session.browse({...kForward, nodeId: open.pop(), referenceTypeId: "HierarchicalReferences"});
    for (const reference of answer.references) {
      const id = reference.nodeId.toString();
      if (nodes.has(id)) continue;
      nodes.set(id, await described(session, names, reference));
      open.push(id);
    }
  }
  return {uris, nodes: [...nodes.values()]};
}

async function write_all(session) {
  const {nodes} = await all_nodes(session);
  const outcomes = {};
  for (const node of nodes.filter((one) => one.kind === "Variable")) {
    const status = await session.write({nodeId: node.id, attributeId: AttributeIds.Value, value: {value: {dataType: "Double", value: 1}}});
    outcomes[status.name] = (outcomes[status.name] ?? 0) + 1;
  }
  return {outcomes, methods: nodes.filter((one) => one.kind === "Method").map((one) => one.id)};
}

async function watch(session) {
  const subscription = await session.createSubscription2({requestedPublishingInterval: 50, requestedLifetimeCount: 600, requestedMaxKeepAliveCount: 10, maxNotificationsPerPublish: 0, publishingEnabled: true, priority: 1});
  const filter = new opcua.DataChangeFilter({trigger: opcua.DataChangeTrigger.StatusValueTimestamp});
  const items = more.map((nodeId) => ({nodeId, attributeId: AttributeIds.Value}));
  const group = await subscription.monitorItems(items, {samplingInterval: 0, queueSize: 20, discardOldest: true, filter}, opcua.TimestampsToReturn.Both);
  group.on("changed", (item, {value, statusCode, sourceTimestamp}) => say({id: item.itemToMonitor.nodeId.toString(), value: value.value, status: statusCode.name, source: sourceTimestamp?.getTime(), at: Date.now()}));
  await new Promise((resolve) => process.on("SIGTERM", resolve));
}

async function abandon(count) {
  for (let made = 0; made < count; ++made) {
    const client = OPCUAClient.create({endpointMustExist: false, requestedSessionTimeout: 3_000_000, keepSessionAlive: false, connectionStrategy: {maxRetry: 0}});
    await client.connect(url);
    await client.createSession();
  }
  return {made: count};
}

async function session_by(mode, policy, folder) {
  const certificates = new OPCUACertificateManager({rootFolder: folder, automaticallyAcceptUnknownCertificate: true, keySize: 2048});
  await certificates.initialize();
  try {
    return await with_session({securityMode: MessageSecurityMode[mode], securityPolicy: SecurityPolicy[policy], clientCertificateManager: certificates, connectionStrategy: {maxRetry: 0}},
      async (session) => ({uris: (await session.readNamespaceArray()).length}));
  } catch (error) {
    return {refused: error.message};
  }
}

async function endpoints() {
  const client = OPCUAClient.create({endpointMustExist: false, connectionStrategy: {maxRetry: 5}});
  await client.connect(url);
  const found = await client.getEndpoints();
  await client.disconnect();
  return found.map((one) => ({url: one.endpointUrl, mode: MessageSecurityMode[one.securityMode], policy: one.securityPolicyUri.split("#")[1], users: one.userIdentityTokens.map((token) => opcua.UserTokenType[token.tokenType])}));
}

if (what === "endpoints") await say(await endpoints());
else if (what === "session") await say(await session_by(...more));
else if (what === "abandon") await say(await abandon(Number(more[0])));
else if (what === "browse") await say(await with_session({}, all_nodes));
else if (what === "write") await say(await with_session({}, write_all));
else await with_session({}, watch);
process.exit(0);
