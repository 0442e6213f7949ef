// The nodes of one robot: a motion device with its axes and power trains, its task control, its safety state.
import {kCategories, kUnknown, joint_values, robot_values} from "./cell_values.mjs";
import {node_id} from "./node_ids.mjs";
import {report_all} from "./reported.mjs";
import {kUnits} from "./units.mjs";

const kNameplate = Object.freeze({manufacturer: "Manufacturer", model: "Model", product_code: "ProductCode", serial_number: "SerialNumber"});

// What decides which nodes a robot has; while it stays the same, so do they.
export function shape_of(robot) {
  return JSON.stringify([robot.id, robot.joints.map(({name, linear}) => [name, linear])]);
}

function report_nameplate(factory, node, nameplate, asked_ms) {
  for (const [key, name] of Object.entries(kNameplate)) {
    const text = nameplate[key];
    factory.reported(node, name).report(text === undefined ? kUnknown : {value: text, quality: "Good"}, asked_ms);
  }
}

function add_axis(factory, device, id, joint) {
  const axis = factory.object("AxisType", {name: joint.name, id: node_id(...id, "Axes", joint.name), parent: factory.child(device, "Axes"), optionals: ["ParameterSet.ActualSpeed"]});
  const position = factory.child(axis, "ParameterSet", "ActualPosition");
  const speed = factory.child(axis, "ParameterSet", "ActualSpeed");
  factory.set_unit(position, joint.linear ? kUnits.millimetre : kUnits.degree);
  factory.set_unit(speed, joint.linear ? kUnits.millimetre_per_second : kUnits.degree_per_second);
  return {
    axis,
    reported: {
      position: factory.reported(axis, "ParameterSet", "ActualPosition"),
      speed: factory.reported(axis, "ParameterSet", "ActualSpeed"),
      range: factory.range(position),
      profile: factory.reported(axis, "MotionProfile"),
    },
  };
}

// The specification demands a power train with a motor. The gateway sees joints and no drives: one for each axis, of which
// nothing is known.
function add_power_train(factory, device, id, joint, axis, asked_ms) {
  const train = factory.object("PowerTrainType", {name: joint.name, id: node_id(...id, "PowerTrains", joint.name), parent: factory.child(device, "PowerTrains")});
  const motor = factory.object("MotorType", {name: "Motor", id: node_id(...id, "PowerTrains", joint.name, "Motor"), parent: train});
  report_nameplate(factory, motor, {}, asked_ms);
  factory.set_unit(factory.child(motor, "ParameterSet", "MotorTemperature"), kUnits.degree_celsius);
  factory.reported(motor, "ParameterSet", "MotorTemperature").report(kUnknown, asked_ms);
  factory.refer(train, "Moves", axis);
}

export class RobotNodes {
  // `places`: {devices, tasks, safety}, where its three objects go. `nameplate`: what is known of the machine.
  constructor(factory, places, instance, robot, nameplate, asked_ms) {
    this.factory_ = factory;
    this.shape = shape_of(robot);
    const id = [instance, robot.id];
    const device = factory.object("MotionDeviceType", {name: robot.id, id: node_id(...id), parent: places.devices, optionals: ["ParameterSet.OnPath"]});
    report_nameplate(factory, device, nameplate, asked_ms);
    const category = kCategories[nameplate.category];
    factory.reported(device, "MotionDeviceCategory").report(category === undefined ? {value: kCategories.other, quality: "UncertainInitialValue"} : {value: category, quality: "Good"}, asked_ms);
    this.joints_ = new Map();
    for (const joint of robot.joints) {
      const {axis, reported} = add_axis(factory, device, id, joint);
      add_power_train(factory, device, id, joint, axis, asked_ms);
      this.joints_.set(joint.name, reported);
    }
    const task = factory.object("TaskControlType", {name: robot.id, id: node_id(instance, "", "TaskControls", robot.id), parent: places.tasks});
    factory.reported(task, "ComponentName").report({value: robot.id, quality: "Good"}, asked_ms);
    factory.refer(task, "Controls", device);
    const safety = factory.object("SafetyStateType", {name: robot.id, id: node_id(instance, "", "SafetyStates", robot.id), parent: places.safety});
    const parameters = factory.child(device, "ParameterSet");
    this.reported_ = {
      mode: factory.variable(parameters, "Mode", "String", {description: "simulated: the gateway moves it; mirrored: it follows a stream of the machine"}),
      stream: factory.variable(parameters, "StreamState", "String", {description: "of the stream of joint values: off, none, fresh, stale, lost, invalid, implausible, conflict"}),
      on_path: factory.reported(device, "ParameterSet", "OnPath"),
      speed_override: factory.reported(device, "ParameterSet", "SpeedOverride"),
      program_name: factory.reported(task, "ParameterSet", "TaskProgramName"),
      program_loaded: factory.reported(task, "ParameterSet", "TaskProgramLoaded"),
      operational_mode: factory.reported(safety, "ParameterSet", "OperationalMode"),
      emergency_stop: factory.reported(safety, "ParameterSet", "EmergencyStop"),
      protective_stop: factory.reported(safety, "ParameterSet", "ProtectiveStop"),
    };
    this.objects_ = [task, safety, device];
  }

  // `changed(values)`: what is reported of values, as they are by default.
  report(robot, asked_ms, changed = (values) => values) {
    report_all(this.reported_, changed(robot_values(robot)), asked_ms);
    for (const joint of robot.joints) {
      const reported = this.joints_.get(joint.name);
      if (reported) report_all(reported, changed(joint_values(robot, joint)), asked_ms);
    }
  }

  remove() {
    for (const node of this.objects_) this.factory_.remove(node);
  }
}
