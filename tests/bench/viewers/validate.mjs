// validate.mjs MODULES FILE...: what the Khronos validator has to say of glTF files, as JSON:
// [{file, errors, warnings, first}], first: the first error's message or null.
import { createRequire } from 'node:module';
import { readFileSync } from 'node:fs';
import { dirname, join } from 'node:path';

const [modules, ...files] = process.argv.slice(2);
const validator = createRequire(join(modules, 'x.js'))('gltf-validator');
const answers = [];
for (const file of files) {
    const report = await validator.validateBytes(new Uint8Array(readFileSync(file)), {
        uri: file,
        externalResourceFunction: async uri =>
            new Uint8Array(readFileSync(join(dirname(file), decodeURIComponent(uri)))),
    });
    const first = report.issues.messages.find(issue => issue.severity === 0);
    answers.push({
        file, errors: report.issues.numErrors, warnings: report.issues.numWarnings,
        first: first ? `${first.pointer}: ${first.message}` : null,
    });
}
console.log(JSON.stringify(answers));
