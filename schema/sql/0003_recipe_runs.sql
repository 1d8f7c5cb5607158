-- 0003: reports of runs, one kind of document for each recipe, so that those of one are read without those of all others.
-- Until here: kind 'recipe_run', name 'NAME/NUMBER'. From here: kind 'recipe_run NAME', name 'NUMBER' (ten digits).
-- A run under way is the document NAME of the kind 'recipe_run_under_way' until it has ended.
UPDATE document
SET kind = 'recipe_run ' || substr(name, 1, instr(name, '/') - 1),
    name = substr(name, instr(name, '/') + 1)
WHERE kind = 'recipe_run' AND instr(name, '/') > 1;
