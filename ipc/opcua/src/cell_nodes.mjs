// The nodes of one cell: a motion device system with the robots of its gateway, the gateway as its controller, and what the
// gateway computes of the cell as a whole.
import {cell_values, kUnknown, without_gateway} from "./cell_values.mjs";
import {node_id} from "./node_ids.mjs";
import {RobotNodes, shape_of} from "./robot_nodes.mjs";
import {report_all} from "./reported.mjs";
import {kUnits} from "./units.mjs";

function reported_of_cell(factory, system) {
  const cell = factory.plain_object(system, "Cell", "What the gateway computes of the cell as a whole");
  return {
    answers: factory.variable(cell, "GatewayAnswers", "Boolean"),
    collisions_tested: factory.variable(cell, "CollisionsTested", "Boolean"),
    touching: factory.variable(cell, "TouchingPairs", "UInt32", {description: "Number of pairs of bodies that touch"}),
    nearest_distance: factory.variable(cell, "NearestDistance", "Double", {unit: kUnits.millimetre, description: "Of the nearest pair of bodies that is watched; 0: they touch"}),
    nearest_pair: factory.variable(cell, "NearestPair", "String", {is_array: true, description: "Paths of its two bodies"}),
    alarms: factory.variable(cell, "UnacknowledgedAlarms", "UInt32"),
    highest_priority: factory.variable(cell, "HighestPriority", "String", {description: "Of the unacknowledged alarms"}),
    problems: factory.variable(cell, "Problems", "String", {is_array: true, description: "Of the gateway itself, with their remedies"}),
  };
}

export class CellNodes {
  // `nameplates`: by robot. The cell has no robots until its gateway has answered.
  constructor(factory, instance, nameplates, now_ms) {
    this.factory_ = factory;
    this.instance_ = instance;
    this.nameplates_ = nameplates;
    this.robots_ = new Map();
    this.image_ = null;
    this.system_ = factory.object("MotionDeviceSystemType", {name: instance, id: node_id(instance), parent: factory.device_set(), description: "A workcell as its cellmirror gateway sees it"});
    const controller = factory.object("ControllerType", {
      name: "Gateway",
      id: node_id(instance, "", "Gateway"),
      parent: factory.child(this.system_, "Controllers"),
      description: "The gateway: it runs the programs of simulated robots and mirrors the others, which it does not control",
    });
    const software = factory.object("SoftwareType", {name: "cellmirror", id: node_id(instance, "", "Gateway", "cellmirror"), parent: factory.child(controller, "Software")});
    for (const node of [controller, software]) {
      factory.reported(node, "Manufacturer").report({value: "cellmirror", quality: "Good"}, now_ms);
      factory.reported(node, "Model").report({value: "cellmirror gateway", quality: "Good"}, now_ms);
    }
    factory.reported(controller, "ProductCode").report({value: "cellmirror", quality: "Good"}, now_ms);
    factory.reported(controller, "SerialNumber").report(kUnknown, now_ms);
    factory.reported(controller, "CurrentUser", "Level").report(kUnknown, now_ms);
    this.places_ = {
      devices: factory.child(this.system_, "MotionDevices"),
      tasks: factory.child(controller, "TaskControls"),
      safety: factory.child(this.system_, "SafetyStates"),
    };
    this.reported_ = reported_of_cell(factory, this.system_);
    this.reported_.version = factory.reported(software, "SoftwareRevision");
    this.report_unanswered_("BadNoCommunication", now_ms);
  }

  // The answer of a request that was sent at `asked_ms`.
  report(image, asked_ms) {
    const present = new Set(image.robots.map((robot) => robot.id));
    for (const id of [...this.robots_.keys()].filter((one) => !present.has(one))) this.remove_(id);
    for (const robot of image.robots) this.nodes_of_(robot, asked_ms).report(robot, asked_ms);
    report_all(this.reported_, cell_values(image), asked_ms);
    this.image_ = {image, asked_ms};
  }

  // The gateway is late, and the last values are reported as such; their times stay.
  report_late() {
    this.report_again_("UncertainNoCommunicationLastUsableValue", this.image_?.asked_ms);
  }

  // The gateway is gone.
  report_gone(now_ms) {
    this.report_again_("BadNoCommunication", now_ms);
    this.report_unanswered_("BadNoCommunication", now_ms);
  }

  report_again_(quality, at_ms) {
    if (!this.image_) return;
    const {image} = this.image_;
    const changed = (values) => without_gateway(values, quality);
    for (const robot of image.robots) this.robots_.get(robot.id)?.report(robot, at_ms, changed);
    report_all(this.reported_, changed(cell_values(image)), at_ms);
  }

  report_unanswered_(quality, now_ms) {
    for (const one of Object.values(this.reported_)) one.report({quality}, now_ms);
    this.reported_.answers.report({value: false, quality: "Good"}, now_ms);
  }

  nodes_of_(robot, asked_ms) {
    const found = this.robots_.get(robot.id);
    if (found?.shape === shape_of(robot)) return found;
    this.remove_(robot.id);
    const nameplate = this.nameplates_.get(robot.id) ?? {};
    const made = new RobotNodes(this.factory_, this.places_, this.instance_, robot, nameplate, asked_ms);
    this.robots_.set(robot.id, made);
    return made;
  }

  remove_(id) {
    this.robots_.get(id)?.remove();
    this.robots_.delete(id);
  }
}
