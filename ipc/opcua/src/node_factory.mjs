// Makes nodes by the types of the companion specification: OPC 40010-1 (Robotics 1.01) and the device model (DI) that it builds on.
import opcua from "node-opcua";

import {kChildMark} from "./node_ids.mjs";
import {Reported} from "./reported.mjs";

const {DataType} = opcua;
opcua.NamespaceOptions.nodeIdNameSeparator = kChildMark;
const kRobotics = "http://opcfoundation.org/UA/Robotics/";
const kDevices = "http://opcfoundation.org/UA/DI/";
const kDeviceSet = 5001; // DI: the object below which devices are found
const kReadOnly = {accessLevel: "CurrentRead", userAccessLevel: "CurrentRead"};
const kOwn = 1; // the server's own namespace

export class NodeFactory {
  constructor(address_space) {
    this.space_ = address_space;
    this.robotics_ = address_space.getNamespaceIndex(kRobotics);
    this.devices_ = address_space.getNamespaceIndex(kDevices);
    this.own_ = address_space.getOwnNamespace();
  }

  device_set() {
    return this.space_.findNode(`ns=${this.devices_};i=${kDeviceSet}`);
  }

  // An instance, with what its type makes mandatory and the `optionals` by their path ("ParameterSet.OnPath").
  object(type, {name, id, parent, optionals = [], description}) {
    const found = this.space_.findObjectType(type, this.robotics_) ?? this.space_.findObjectType(type, this.devices_);
    return found.instantiate({browseName: {name, namespaceIndex: kOwn}, displayName: name, nodeId: id, componentOf: parent, optionals, description});
  }

  // A component or property of `node` by its names.
  child(node, ...names) {
    let found = node;
    for (const name of names) {
      const next = found.getComponentByName(name) ?? found.getPropertyByName(name);
      if (!next) throw new Error(`${found.nodeId} has no ${name}`);
      found = next;
    }
    return found;
  }

  reported(node, ...names) {
    return new Reported(this.child(node, ...names));
  }

  // A plain object of ours below `parent`.
  plain_object(parent, name, description) {
    return this.own_.addObject({componentOf: parent, browseName: {name, namespaceIndex: kOwn}, nodeId: this.below_(parent, name), typeDefinition: "BaseObjectType", description});
  }

  // A variable of ours: no companion specification names it.
  variable(parent, name, data_type, {is_array = false, unit = null, description} = {}) {
    const options = {
      componentOf: parent,
      browseName: {name, namespaceIndex: kOwn},
      nodeId: this.below_(parent, name),
      dataType: data_type,
      valueRank: is_array ? 1 : -1,
      ...kReadOnly,
      description,
    };
    if (!unit) return new Reported(this.own_.addVariable(options));
    const variable = this.own_.addVariable({...options, typeDefinition: "AnalogUnitType"});
    this.property_(variable, "EngineeringUnits", "EUInformation").setValueFromSource({dataType: DataType.ExtensionObject, value: unit});
    return new Reported(variable);
  }

  set_unit(variable, unit) {
    this.child(variable, "EngineeringUnits").setValueFromSource({dataType: DataType.ExtensionObject, value: unit});
  }

  // The optional EURange of an AnalogUnitType, which AxisType does not mention.
  range(variable) {
    return new Reported(this.property_(variable, "EURange", "Range"));
  }

  // A reference of the Robotics specification: Moves, Controls, IsConnectedTo.
  refer(from, type, to) {
    from.addReference({referenceType: this.space_.findReferenceType(type, this.robotics_).nodeId, nodeId: to.nodeId});
  }

  remove(node) {
    this.space_.deleteNode(node);
  }

  property_(variable, name, data_type) {
    const found = variable.getPropertyByName(name);
    const options = {propertyOf: variable, browseName: {name, namespaceIndex: 0}, nodeId: this.below_(variable, name), dataType: data_type, typeDefinition: "PropertyType"};
    return found ?? this.own_.addVariable({...options, ...kReadOnly});
  }

  below_(parent, name) {
    return `s=${parent.nodeId.value}${kChildMark}${name}`;
  }
}
