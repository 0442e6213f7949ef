#!/usr/bin/env -S node --max-old-space-size=768
import {main} from "./src/main.mjs";

process.exit(await main(process.argv.slice(2)));
