// The OPC UA server: what it offers to whom, and its limits.
import os from "node:os";
import opcua from "node-opcua";

const {MessageSecurityMode, OPCUAServer, RegisterServerMethod, SecurityPolicy, nodesets} = opcua;

// For a plant's few clients, each with every axis of every robot.
export const kLimits = Object.freeze({
  connections: 32,
  sessions: 20,
  subscriptions: 40,
  subscriptions_per_session: 10,
  monitored_items: 40_000,
  monitored_items_per_subscription: 10_000,
  message_bytes: 4 * 1024 * 1024,
  chunk_bytes: 64 * 1024,
});

// `hello`: what a client proposes, 0 for no limit of its own.
export function transport_limits(hello) {
  const within = (proposed, least, greatest) => Math.min(Math.max(proposed || greatest, least), greatest);
  const {chunk_bytes, message_bytes} = kLimits;
  return {
    receiveBufferSize: within(hello.receiveBufferSize, 8192, chunk_bytes),
    sendBufferSize: within(hello.sendBufferSize, 8192, chunk_bytes),
    maxMessageSize: within(hello.maxMessageSize, chunk_bytes, message_bytes),
    maxChunkCount: within(hello.maxChunkCount, 1, message_bytes / 8192),
  };
}

const kCapabilities = {
  maxSessions: kLimits.sessions,
  maxSubscriptions: kLimits.subscriptions,
  maxSubscriptionsPerSession: kLimits.subscriptions_per_session,
  maxMonitoredItems: kLimits.monitored_items,
  maxMonitoredItemsPerSubscription: kLimits.monitored_items_per_subscription,
  maxMonitoredItemsQueueSize: 1000,
  maxBrowseContinuationPoints: 10,
  maxStringLength: 65_536,
  maxArrayLength: 65_536,
  maxByteStringLength: 1024 * 1024,
  operationLimits: {maxNodesPerRead: 10_000, maxNodesPerBrowse: 2000, maxNodesPerWrite: 100, maxNodesPerMethodCall: 10, maxMonitoredItemsPerCall: 10_000, maxNodesPerRegisterNodes: 2000, maxNodesPerTranslateBrowsePathsToNodeIds: 2000},
};

// `options`: of the command line. Not started yet.
export async function make_server(options, certificates, version) {
  const server = new OPCUAServer({
    host: options.bind,
    hostname: options.hostname,
    port: options.port,
    securityModes: [MessageSecurityMode.SignAndEncrypt, MessageSecurityMode.Sign, ...(options.unencrypted ? [MessageSecurityMode.None] : [])],
    securityPolicies: [SecurityPolicy.Basic256Sha256, SecurityPolicy.Aes128_Sha256_RsaOaep, SecurityPolicy.Aes256_Sha256_RsaPss, ...(options.unencrypted ? [SecurityPolicy.None] : [])],
    // Who the client is, its certificate says; beyond this machine it must be trusted. There are no users.
    allowAnonymous: true,
    userManager: {isValidUser: () => false},
    serverCertificateManager: certificates,
    userCertificateManager: certificates,
    serverInfo: {applicationUri: `urn:${os.hostname()}:cellmirror-opcua`, productUri: "urn:cellmirror:opcua", applicationName: {text: "cellmirror-opcua"}},
    buildInfo: {productName: "cellmirror-opcua", productUri: "urn:cellmirror:opcua", manufacturerName: "cellmirror", softwareVersion: version, buildNumber: version, buildDate: new Date(0)},
    nodeset_filename: [nodesets.standard, nodesets.di, nodesets.robotics],
    registerServerMethod: RegisterServerMethod.HIDDEN,
    maxConnectionsPerEndpoint: kLimits.connections,
    serverCapabilities: kCapabilities,
    transportSettings: {adjustTransportLimits: transport_limits},
  });
  await server.initialize();
  return server;
}
