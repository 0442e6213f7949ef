// One variable of the address space, and what was reported of it.
import opcua from "node-opcua";

const {DataType, StatusCodes, VariantArrayType} = opcua;

function same(a, b) {
  if (Array.isArray(a) && Array.isArray(b)) return a.length === b.length && a.every((one, i) => one === b[i]);
  return a === b;
}

export class Reported {
  constructor(variable) {
    this.variable_ = variable;
    this.type_ = variable.getBasicDataType();
    this.is_array_ = variable.valueRank === 1;
    this.last_ = null;
  }

  // `one`: {value, quality, age_s} as in cell_values.mjs. Its SourceTimestamp is `asked_ms` (of Date.now()) less its age; without
  // an age, the time when it changed. What is bad has no value.
  report(one, asked_ms) {
    const {value, quality, age_s} = one;
    if (age_s === undefined && this.last_ && this.last_.quality === quality && same(this.last_.value, value)) return;
    this.last_ = {value, quality};
    this.variable_.setValueFromSource(this.variant_(value), StatusCodes[quality], new Date(asked_ms - 1000 * (age_s ?? 0)));
  }

  variant_(value) {
    if (value === undefined) return {dataType: DataType.Null};
    if (this.is_array_) return {dataType: this.type_, arrayType: VariantArrayType.Array, value};
    if (this.type_ === DataType.LocalizedText) return {dataType: this.type_, value: {text: value}};
    return {dataType: this.type_, value: Array.isArray(value) ? new opcua.Range({low: value[0], high: value[1]}) : value};
  }
}

// Each of `values` to the variable of the same name.
export function report_all(reported, values, asked_ms) {
  for (const [key, one] of Object.entries(values)) reported[key]?.report(one, asked_ms);
}
