// The nodes of one cell: a motion device system with the robots of its gateway, the gateway as its controller, and what the
// gateway computes of the cell as a whole.
import {cell_values, kUnknown, without_gateway} from "./cell_values.mjs";
import {node_id} from "./node_ids.mjs";
import {RobotNodes, shape_of} from "./robot_nodes.mjs";
import {tell_all} from "./told.mjs";
import {kUnits} from "./units.mjs";

function told_of_cell(factory, system) {
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
      factory.told(node, "Manufacturer").tell({value: "cellmirror", quality: "Good"}, now_ms);
      factory.told(node, "Model").tell({value: "cellmirror gateway", quality: "Good"}, now_ms);
    }
    factory.told(controller, "ProductCode").tell({value: "cellmirror", quality: "Good"}, now_ms);
    factory.told(controller, "SerialNumber").tell(kUnknown, now_ms);
    factory.told(controller, "CurrentUser", "Level").tell(kUnknown, now_ms);
    this.places_ = {
      devices: factory.child(this.system_, "MotionDevices"),
      tasks: factory.child(controller, "TaskControls"),
      safety: factory.child(this.system_, "SafetyStates"),
    };
    this.told_ = told_of_cell(factory, this.system_);
    this.told_.version = factory.told(software, "SoftwareRevision");
    this.tell_unanswered_("BadNoCommunication", now_ms);
  }

  // The answer of a request that was sent at `asked_ms`.
  tell(image, asked_ms) {
    const present = new Set(image.robots.map((robot) => robot.id));
    for (const id of [...this.robots_.keys()].filter((one) => !present.has(one))) this.remove_(id);
    for (const robot of image.robots) this.nodes_of_(robot, asked_ms).tell(robot, asked_ms);
    tell_all(this.told_, cell_values(image), asked_ms);
    this.image_ = {image, asked_ms};
  }

  // The gateway is late, and the last values are told as such; their times stay.
  tell_late() {
    this.tell_again_("UncertainNoCommunicationLastUsableValue", this.image_?.asked_ms);
  }

  // The gateway is gone.
  tell_gone(now_ms) {
    this.tell_again_("BadNoCommunication", now_ms);
    this.tell_unanswered_("BadNoCommunication", now_ms);
  }

  tell_again_(quality, at_ms) {
    if (!this.image_) return;
    const {image} = this.image_;
    const changed = (values) => without_gateway(values, quality);
    for (const robot of image.robots) this.robots_.get(robot.id)?.tell(robot, at_ms, changed);
    tell_all(this.told_, changed(cell_values(image)), at_ms);
  }

  tell_unanswered_(quality, now_ms) {
    for (const one of Object.values(this.told_)) one.tell({quality}, now_ms);
    this.told_.answers.tell({value: false, quality: "Good"}, now_ms);
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
