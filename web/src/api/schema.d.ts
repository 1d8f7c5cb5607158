// Generated from schema/openapi.yaml by `npm run api`. Do not edit: change the description and run it again.
export interface paths {
    "/healthz": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** The process is alive */
        get: operations["getHealth"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/readyz": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** The gateway is ready to serve, or what is missing */
        get: operations["getReady"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/metrics": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** Counters and gauges as Prometheus text */
        get: operations["getMetrics"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/openapi.yaml": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** This description */
        get: operations["getDescription"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/about": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** Name, version, families, doors and their addresses */
        get: operations["getAbout"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/families": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** The drive families */
        get: operations["listFamilies"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/families/{family}": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example uim342 */
                family: components["parameters"]["family"];
            };
            cookie?: never;
        };
        /** One family, with everything its catalogue says beside parameters, commands and errors */
        get: operations["getFamily"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/families/{family}/parameters": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example uim342 */
                family: components["parameters"]["family"];
            };
            cookie?: never;
        };
        /** The parameters of the family, in the order of the manual */
        get: operations["listFamilyParameters"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/families/{family}/commands": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example uim342 */
                family: components["parameters"]["family"];
            };
            cookie?: never;
        };
        /** The drive's own commands */
        get: operations["listFamilyCommands"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/families/{family}/errors": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example uim342 */
                family: components["parameters"]["family"];
            };
            cookie?: never;
        };
        /** The drive's own error codes */
        get: operations["listFamilyErrors"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/lines": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** All lines, with their state */
        get: operations["listLines"];
        put?: never;
        /** Adds a line */
        post: operations["addLine"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/lines/{line}": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example can0 */
                line: components["parameters"]["line"];
            };
            cookie?: never;
        };
        /** One line, with its state */
        get: operations["getLine"];
        /** Replaces a line; another `name` in the body renames it, and its drives follow */
        put: operations["replaceLine"];
        post?: never;
        /** Removes a line; 409 while drives hang on it, unless `cascade` */
        delete: operations["removeLine"];
        options?: never;
        head?: never;
        /** Changes some members of a line (JSON merge patch; null removes a member) */
        patch: operations["changeLine"];
        trace?: never;
    };
    "/api/v1/lines/{line}/trace": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example can0 */
                line: components["parameters"]["line"];
            };
            cookie?: never;
        };
        /**
         * Recorded frames, oldest first
         * @description Without `format` the `Accept` header decides. A gap in `sequence`, or `missed` above 0, means that frames were overwritten
         *     before they were read. Ask again with `since` = `next` for what came later.
         */
        get: operations["getTrace"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/host/ports": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** Serial ports and CAN interfaces of the gateway's machine, to choose a line's URI from; none is opened */
        get: operations["listHostPorts"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/lines/{line}/scan": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example can0 */
                line: components["parameters"]["line"];
            };
            cookie?: never;
        };
        /** The last search for drives on the line, also while it goes on */
        get: operations["getScan"];
        put?: never;
        /** Looks for drives at addresses that the site has not given to one; polls go on, nothing is written to any drive */
        post: operations["startScan"];
        /** Ends the search; what was found stays in the report */
        delete: operations["cancelScan"];
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/drives": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** All drives, with their presence */
        get: operations["listDrives"];
        put?: never;
        /** Adds a drive */
        post: operations["addDrive"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/drives/{drive}": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example feeder */
                drive: components["parameters"]["drive"];
            };
            cookie?: never;
        };
        /** One drive, with its presence */
        get: operations["getDrive"];
        /** Replaces a drive; another `name` in the body renames it, and its axes follow */
        put: operations["replaceDrive"];
        post?: never;
        /** Removes a drive; 409 while axes hang on it, unless `cascade` */
        delete: operations["removeDrive"];
        options?: never;
        head?: never;
        /** Changes some members of a drive (JSON merge patch; null removes a member) */
        patch: operations["changeDrive"];
        trace?: never;
    };
    "/api/v1/drives/{drive}/native": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example feeder */
                drive: components["parameters"]["drive"];
            };
            cookie?: never;
        };
        get?: never;
        put?: never;
        /** One exchange in the drive's own language, through the line's queue */
        post: operations["exchangeNative"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/drives/{drive}/hand": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example feeder */
                drive: components["parameters"]["drive"];
            };
            cookie?: never;
        };
        /** The outside conditions of a simulated drive; 409 while the drive is not simulated */
        get: operations["getHand"];
        /** Sets the named conditions, all or none; those not named stay */
        put: operations["setHand"];
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        /** Sets the named conditions, all or none; those not named stay */
        patch: operations["changeHand"];
        trace?: never;
    };
    "/api/v1/axes": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** All axes, with their state */
        get: operations["listAxes"];
        put?: never;
        /** Adds an axis */
        post: operations["addAxis"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/axes/{axis}": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example feeder */
                axis: components["parameters"]["axis"];
            };
            cookie?: never;
        };
        /** One axis, with its state */
        get: operations["getAxis"];
        /** Replaces an axis; another `name` in the body renames it */
        put: operations["replaceAxis"];
        post?: never;
        /** Removes an axis; 409 while mappings name it, unless `cascade` */
        delete: operations["removeAxis"];
        options?: never;
        head?: never;
        /** Changes some members of an axis (JSON merge patch; null removes a member) */
        patch: operations["changeAxis"];
        trace?: never;
    };
    "/api/v1/axes/{axis}/commands": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example feeder */
                axis: components["parameters"]["axis"];
            };
            cookie?: never;
        };
        get?: never;
        put?: never;
        /**
         * Commands an axis
         * @description Without `wait` the answer comes when the drive has acknowledged the command (`accepted`). With `wait` it comes when the
         *     command is done (target reached, homed, powered), or when the time is over: then the answer is `accepted` with the reason
         *     `not done after N s`, and the command goes on. A command that is refused or failed is answered with a problem, which
         *     carries `ticket`, `result` and `reason` too.
         */
        post: operations["commandAxis"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/axes/{axis}/actions": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example feeder */
                axis: components["parameters"]["axis"];
            };
            cookie?: never;
        };
        get?: never;
        put?: never;
        /** A function of the drive's family beyond the common commands, by its catalogue name */
        post: operations["actOnAxis"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/authority": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** Who holds each axis */
        get: operations["listAuthority"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/axes/{axis}/authority": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example feeder */
                axis: components["parameters"]["axis"];
            };
            cookie?: never;
        };
        /** Who holds the axis */
        get: operations["getAuthority"];
        /** Takes or renews the lease; X-Client names the client beside its address */
        put: operations["takeAuthority"];
        post?: never;
        /** Gives the lease up */
        delete: operations["releaseAuthority"];
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/axes/{axis}/authority/hand-over": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example feeder */
                axis: components["parameters"]["axis"];
            };
            cookie?: never;
        };
        get?: never;
        put?: never;
        /** Gives the lease to another client */
        post: operations["handOverAuthority"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/modbus": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** Locks and clients of the Modbus door */
        get: operations["getModbus"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        /** Makes the door read-only, or not; kept over a restart */
        patch: operations["changeModbus"];
        trace?: never;
    };
    "/api/v1/connections": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Who is connected over EtherNet/IP and Modbus/TCP
         * @description EtherNet/IP sessions, connections of messages and of implicit data, and Modbus/TCP connections. They are told anew with each request.
         */
        get: operations["listConnections"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/connections/{connection}": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @description its id in the list */
                connection: string;
            };
            cookie?: never;
        };
        get?: never;
        put?: never;
        post?: never;
        /**
         * Closes one connection of a client
         * @description It ends as if its network had ended it. Its client is lost for the axes that it commanded by it, and each of them does what its `fail_safe` says. The client may connect again.
         */
        delete: operations["closeConnection"];
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/eds": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** The electronic data sheet by which EtherNet/IP tools know this gateway, made of the site in force */
        get: operations["getEds"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/descriptions": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** The makers' descriptions (EDS and DCF files) that drives may name */
        get: operations["listDescriptions"];
        put?: never;
        /**
         * Keeps an EDS or DCF file, checked as a whole
         * @description The file itself with `?name=`, or JSON with name and text. Faults name the line, and nothing is kept then. A description is never
         *     changed: a name that is taken by another text is refused. Files of other coding than UTF-8 are read as Latin-1.
         */
        post: operations["addDescription"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/descriptions/{description}": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                description: components["parameters"]["description"];
            };
            cookie?: never;
        };
        /** What is in a description, or the file itself */
        get: operations["getDriveDescription"];
        put?: never;
        post?: never;
        /**
         * Removes a description that no drive names
         * @description Drives of the site in force count, of the one that is staged, and of the one that a trial goes back to. An older revision of the site
         *     that names it cannot be restored any more.
         */
        delete: operations["removeDescription"];
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/fail_safe": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** What happens to each axis when whoever commands it is lost, by cause */
        get: operations["getFailSafe"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/fail_safe/{axis}": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example feeder */
                axis: components["parameters"]["axis"];
            };
            cookie?: never;
        };
        /** The same of one axis */
        get: operations["getAxisFailSafe"];
        /**
         * Says what happens to one axis; what is left out or null is the default again. A change of the site
         * @description The path of an axis that is called `rehearsal` is taken; its choice is changed with `PATCH /api/v1/axes/rehearsal`.
         */
        put: operations["putAxisFailSafe"];
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/fail_safe/rehearsal": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** The last rehearsal's report, and how far one that runs has come */
        get: operations["getFailSafeRehearsal"];
        put?: never;
        /**
         * Plays every cause on models of the axes and measures what comes of it; nothing real moves
         * @description Each cell sets the model of the axis in motion (at `velocity_max` where the site has it), takes its client away, and measures until it
         *     stands. Before the loss another client speaks to the axis (`second_client`), and commands of its own client are refused
         *     (`refused_commands`); after the standstill its controller is back and writes what it wrote before (`old_image`); and in a cell of its own
         *     the gateway is killed and started again while the axis moves (`gateway_restart`). The engine, the adapters and the wire times are those of the gateway; the drives are models in a time of their own. One
         *     rehearsal at a time; the last 20 reports are kept.
         */
        post: operations["rehearseFailSafe"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/axes/{axis}/parameters": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example feeder */
                axis: components["parameters"]["axis"];
            };
            cookie?: never;
        };
        /**
         * The parameters of an axis, with the last values known; no exchange with the drive
         * @description The elements of an array of at most 256 are listed one by one. A longer array is one entry, with `first` and `count`; list its
         *     elements with `array`.
         */
        get: operations["listParameters"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/axes/{axis}/parameters/{parameter}": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example feeder */
                axis: components["parameters"]["axis"];
                /**
                 * @description id or name of the catalogue; elements of an array with their number in brackets, percent-encoded (`PP%5B5%5D`)
                 * @example AC
                 */
                parameter: components["parameters"]["parameter"];
            };
            cookie?: never;
        };
        /**
         * Reads one parameter from the drive now
         * @description If the drive does not answer, the last known value is answered with the quality `stale` and `text` says why; if none is known,
         *     503 or 504.
         */
        get: operations["readParameter"];
        /**
         * Writes one parameter; answered by what the drive said
         * @description With `If-Match` it is written only if nobody has written it through the gateway since; else 412, `current` is the last write, and nothing goes to the drive. While another client's write is under way, 409 `busy`.
         */
        put: operations["writeParameter"];
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/moves/start": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        get?: never;
        put?: never;
        /**
         * Starts several prepared axes of one line at the same instant
         * @description Prepare each axis first with a move command that has `"prepare":true`.
         */
        post: operations["startMoves"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/site": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** The whole site as one document */
        get: operations["getSite"];
        /** Replaces the whole site; only what changed is disturbed, and what of it moves is stopped first */
        put: operations["replaceSite"];
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/mappings": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** The site's own register maps */
        get: operations["listMappings"];
        put?: never;
        /** Adds a mapping; 409 names the one whose place it would take */
        post: operations["addMapping"];
        /**
         * Removes several mappings at once, all or none
         * @description Those that fit every condition that is given: of a unit, of an axis, with one of the ids. All of them only with `all=1`.
         *     404 if one of the ids is none.
         */
        delete: operations["removeMappings"];
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/mappings.csv": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** All mappings as a table for a spreadsheet */
        get: operations["exportMappings"];
        /** Replaces all mappings by the rows of a table, or none */
        put: operations["replaceMappings"];
        /**
         * Adds the rows of a table, all or none; a row with a known id takes that mapping's place
         * @description Columns in any order, by the names of the first line; `;` or a tab is taken as separator too. Faults name the line.
         */
        post: operations["addMappings"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/mappings/{mapping}": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @description id of the mapping */
                mapping: string;
            };
            cookie?: never;
        };
        /** One mapping */
        get: operations["getMapping"];
        /** Replaces a mapping */
        put: operations["replaceMapping"];
        post?: never;
        /** Removes a mapping */
        delete: operations["removeMapping"];
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/mapping-points": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** What every axis has to map beside the parameters of its family */
        get: operations["listMappingPoints"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/recipes": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** The stored recipes, in order of name */
        get: operations["listRecipes"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/recipes/{recipe}": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /**
                 * @description 1 to 64 letters, digits, - _ .
                 * @example warm-up
                 */
                recipe: components["parameters"]["recipe"];
            };
            cookie?: never;
        };
        /** One recipe as it was put */
        get: operations["getRecipe"];
        /** Makes or replaces a recipe; all faults of it at once, with pointers */
        put: operations["putRecipe"];
        post?: never;
        /** Removes a recipe and the reports of its runs; 409 while it runs */
        delete: operations["removeRecipe"];
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/recipes/{recipe}/run": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /**
                 * @description 1 to 64 letters, digits, - _ .
                 * @example warm-up
                 */
                recipe: components["parameters"]["recipe"];
            };
            cookie?: never;
        };
        get?: never;
        put?: never;
        /**
         * Starts a run; first everything is checked against the site
         * @description At most 4 recipes run at once, each once, and no axis is commanded by two. The live feed's topic `recipes` carries the report whenever
         *     it changes. A run that fails or is cancelled stops the axes that it has set in motion (`on_failure`): those whose drive has taken its
         *     command, or may have taken it, until the motion has ended, another command or a stop has taken its place, or another client holds the
         *     axis. A command that was refused sets nothing in motion. The reports of the last 20 runs outlive the program; a run that was under way
         *     when the gateway ended is `interrupted`, with the steps known by then (written down at most once a second), and an event says so.
         */
        post: operations["runRecipe"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/recipes/{recipe}/runs": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /**
                 * @description 1 to 64 letters, digits, - _ .
                 * @example warm-up
                 */
                recipe: components["parameters"]["recipe"];
            };
            cookie?: never;
        };
        /** Reports of the last 20 runs, newest first, without their steps */
        get: operations["listRecipeRuns"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/recipes/{recipe}/runs/{run}": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /**
                 * @description 1 to 64 letters, digits, - _ .
                 * @example warm-up
                 */
                recipe: components["parameters"]["recipe"];
                /**
                 * @description number of the run; counts up per recipe, also over restarts
                 * @example 1
                 */
                run: components["parameters"]["run"];
            };
            cookie?: never;
        };
        /** Report of one run, also while it goes on */
        get: operations["getRecipeRun"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/recipes/{recipe}/runs/{run}/cancel": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /**
                 * @description 1 to 64 letters, digits, - _ .
                 * @example warm-up
                 */
                recipe: components["parameters"]["recipe"];
                /**
                 * @description number of the run; counts up per recipe, also over restarts
                 * @example 1
                 */
                run: components["parameters"]["run"];
            };
            cookie?: never;
        };
        get?: never;
        put?: never;
        /** Ends a run; axes that it has set in motion are stopped */
        post: operations["cancelRecipeRun"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/axes/{axis}/snapshots": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example feeder */
                axis: components["parameters"]["axis"];
            };
            cookie?: never;
        };
        /**
         * Snapshots of an axis, oldest first
         * @description They follow the axis to another name, stay when it gets another drive, and are there again when a removed axis is put back (or another of its name is made). `family` tells of which drives each is; only one of the same family is written back.
         */
        get: operations["listSnapshots"];
        put?: never;
        /** Takes a snapshot, of all that can be read from the drive or of what is stored; nothing is stored if the drive falls silent */
        post: operations["takeSnapshot"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/axes/{axis}/snapshot-progress": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example feeder */
                axis: components["parameters"]["axis"];
            };
            cookie?: never;
        };
        /** How far the newest reading or writing of many parameters is */
        get: operations["getSnapshotProgress"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/axes/{axis}/snapshots/{snapshot}": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example feeder */
                axis: components["parameters"]["axis"];
                snapshot: components["parameters"]["snapshot"];
            };
            cookie?: never;
        };
        /** One snapshot, also as a DCF file */
        get: operations["getSnapshot"];
        put?: never;
        post?: never;
        /** Removes a snapshot */
        delete: operations["removeSnapshot"];
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/axes/{axis}/snapshots/{snapshot}/diff": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example feeder */
                axis: components["parameters"]["axis"];
                snapshot: components["parameters"]["snapshot"];
            };
            cookie?: never;
        };
        /** A snapshot beside something else; 409 if that is of another family */
        get: operations["diffSnapshot"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/axes/{axis}/snapshots/{snapshot}/restore": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example feeder */
                axis: components["parameters"]["axis"];
                snapshot: components["parameters"]["snapshot"];
            };
            cookie?: never;
        };
        get?: never;
        put?: never;
        /** Writes what differs to the drive, one parameter at a time; refused while the axis moves, unless nothing would be written, and for a snapshot of another family */
        post: operations["restoreSnapshot"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/axes/{axis}/parameters/{parameter}/history": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example feeder */
                axis: components["parameters"]["axis"];
                /**
                 * @description id or name of the catalogue; elements of an array with their number in brackets, percent-encoded (`PP%5B5%5D`)
                 * @example AC
                 */
                parameter: components["parameters"]["parameter"];
            };
            cookie?: never;
        };
        /** Writes of a parameter through the gateway, newest first */
        get: operations["getParameterHistory"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/axes/{axis}/parameters.csv": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example feeder */
                axis: components["parameters"]["axis"];
            };
            cookie?: never;
        };
        /** Parameters as a table for a spreadsheet */
        get: operations["exportParameters"];
        /** Writes the values of a table; nothing is written if one line is wrong, and nothing while the axis moves */
        put: operations["importParameters"];
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/site/stage": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** The staged site, if there is one */
        get: operations["getStage"];
        put?: never;
        /** Stages a whole site; what was staged before is replaced, another client's only if `replace` says so (409 `stage_taken`) */
        post: operations["stageSite"];
        /** Discards the staged site */
        delete: operations["discardStage"];
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/site/stage/apply": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        get?: never;
        put?: never;
        /** Applies the staged site as one; it rolls back by itself unless it is confirmed in time */
        post: operations["applyStage"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/site/stage/confirm": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        get?: never;
        put?: never;
        /** Keeps the applied site; only the client that applied it may, in the same session */
        post: operations["confirmStage"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/site/stage/roll-back": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        get?: never;
        put?: never;
        /** Takes the applied site back now */
        post: operations["rollBackStage"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/site/history": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Applied sites, newest first
         * @description Every applied state is kept and can be restored: the newest 1000, and of these as many as fit into 256 MiB together; beyond that the oldest go. The list tells of them without their documents, in pages: the next one is asked for with `before`, the smallest revision of the last one.
         */
        get: operations["listSiteHistory"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/site/history/{revision}": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                revision: components["parameters"]["revision"];
            };
            cookie?: never;
        };
        /** The document of a revision */
        get: operations["getSiteRevision"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/site/history/{revision}/restore": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                revision: components["parameters"]["revision"];
            };
            cookie?: never;
        };
        get?: never;
        put?: never;
        /** Stages the site of a revision */
        post: operations["restoreSiteRevision"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/backup": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** The whole gateway as one file, as `axisgate backup` makes it; without private keys unless it is sealed */
        get: operations["getBackup"];
        /** Checks a backup and lays it down to be taken at the next start; at most 64 MiB. Configuration and certificates of the host are taken by `axisgate restore` alone */
        put: operations["putBackup"];
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/backup/pending": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** The backup that was laid down and takes the database's place at the next start, if there is one */
        get: operations["getPendingBackup"];
        put?: never;
        post?: never;
        /** Takes it away again; the next start goes on with the database as it is */
        delete: operations["cancelPendingBackup"];
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/registers": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** Registers as the Modbus door shows them now */
        get: operations["getRegisters"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/mappings/list": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** The register list for people and PLC projects, with the revision of registers 18 and 19 */
        get: operations["getMappingList"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/mappings/next-free": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** The first place with so many free registers in a row */
        get: operations["getNextFree"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/recorder/trends": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * What axes did lately, as their drives told it
         * @description The gateway keeps position, demand, velocity and state of every axis each time its drive tells them, for `[recorder] trend_minutes` and
         *     within `trend_mb`. Between two rows the older one holds; the first row is what held at `from`. A longer stretch than `columns` rows is
         *     thinned to columns of equal length; one in which nothing changed is left out. Each column has the value that held when it began
         *     (`first`), the smallest and the greatest one, so that no peak is lost, and the last one, which holds from `until` to the next column.
         *     Where the drive did not answer, or its word was too old, values are null. In CSV, the first and the last value of a column stand
         *     behind the other points.
         */
        get: operations["getTrends"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/recorder/steps": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * What was done to axes lately, as steps of a recipe
         * @description Commands, actions, parameter writes, set-points and simulated conditions that people and panels gave over any door, in their order, as far
         *     as the recorder's stretch reaches. A motion that had ended before the next step waits for its end; other pauses become `wait_s`. A jog
         *     becomes `move_velocity`, the time it was held, and `halt`. What has no step, or was refused, stands in `left_out`. Steps of recipes and
         *     what the gateway did by itself are none.
         */
        get: operations["getRecordedSteps"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/recorder/captures": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** Fast captures, those that run and those that are kept */
        get: operations["listCaptures"];
        put?: never;
        /**
         * Arms a fast capture
         * @description Until it is over the axes are asked as often as is wished and their line has room for; the line's other drives are asked as often as
         *     before. Each word of a drive is a row. One capture of a line at a time, four in all. It is kept as soon as it is done.
         */
        post: operations["armCapture"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/recorder/captures/{capture}": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                capture: components["parameters"]["capture"];
            };
            cookie?: never;
        };
        /** A capture with its rows; of one that runs, what there is by now */
        get: operations["getCapture"];
        put?: never;
        post?: never;
        /** Cancels a capture that runs, or deletes one that is kept */
        delete: operations["removeCapture"];
        options?: never;
        head?: never;
        /** Gives a capture another name */
        patch: operations["renameCapture"];
        trace?: never;
    };
    "/api/v1/recorder/recordings": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** What is being recorded, and the recordings that were made of it */
        get: operations["listRecordings"];
        put?: never;
        /**
         * Freezes what is recorded into a file
         * @description Commands and who gave them, their results, frames of all lines, states, samples and events under one clock, up to now. Alarms of the
         *     kinds in `[recorder] freeze_on` do it by themselves, two seconds later, once a minute at most.
         */
        post: operations["makeRecording"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/recorder/recordings/{recording}": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                recording: components["parameters"]["recording"];
            };
            cookie?: never;
        };
        /** The file of a recording, or what is known of it */
        get: operations["getRecording"];
        put?: never;
        post?: never;
        /** Deletes a recording */
        delete: operations["removeRecording"];
        options?: never;
        head?: never;
        /** Gives a recording another name */
        patch: operations["renameRecording"];
        trace?: never;
    };
    "/api/v1/recorder/recordings/{recording}/playback": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                recording: components["parameters"]["recording"];
            };
            cookie?: never;
        };
        /**
         * What a recording shows of one instant
         * @description Axes as they were, their registers as unit 1 had them (the high word first), the last frames with their reading, and what had happened
         *     lately. With `columns` also the curves of the whole stretch.
         */
        get: operations["playBackRecording"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/fleet": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** The gateways of the DDS domain and their axes, this one included */
        get: operations["getFleet"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/fleet/{gateway}/axes/{axis}/commands": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @description name of a gateway of the domain */
                gateway: string;
                /** @example feeder */
                axis: components["parameters"]["axis"];
            };
            cookie?: never;
        };
        get?: never;
        put?: never;
        /**
         * Commands an axis of any gateway of the domain
         * @description As a command to an axis of this gateway; it goes by DDS, is carried out once and comes back with its one result. The other gateway's authority, limits and fail-safe hold.
         */
        post: operations["commandFleetAxis"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/assemblies": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * EtherNet/IP assembly instances of the site's own and of its profiles, and what stands at which byte
         * @description Those that every site has are not among them; 100+n and 150+n of the axes, heartbeats, configuration.
         */
        get: operations["listAssemblies"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/assemblies.csv": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** The site's own assemblies as a table for a spreadsheet */
        get: operations["exportAssemblies"];
        /** Replaces the site's own assemblies by the rows of a table, or none */
        put: operations["replaceAssemblies"];
        /**
         * Adds the rows of a table, all or none; a row with a known instance takes that assembly's place
         * @description Columns in any order, by the names of the first line; `;` or a tab is taken as separator too. Faults name the line. Connections that are open on EtherNet/IP are closed with the cause.
         */
        post: operations["addAssemblies"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/assemblies/{instance}": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @description assembly instance, 1 to 65535 */
                instance: string;
            };
            cookie?: never;
        };
        /** An assembly of the site's own */
        get: operations["getAssembly"];
        /**
         * Serves a range of a unit's registers as an assembly
         * @description Connections that are open on EtherNet/IP are closed with the cause, as after every change of the layout.
         */
        put: operations["putAssembly"];
        post?: never;
        /** Takes an assembly away */
        delete: operations["removeAssembly"];
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/profiles": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** Units that speak another device's language, and what stands where in each language */
        get: operations["listProfiles"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/profiles/{unit}": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @description Modbus unit, 2 to 254 */
                unit: string;
            };
            cookie?: never;
        };
        /** The profile of a unit */
        get: operations["getProfile"];
        /** Lets a unit speak another device's language */
        put: operations["putProfile"];
        post?: never;
        /** Takes the profile of a unit away */
        delete: operations["removeProfile"];
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/mappings/units": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** Modbus units with mappings or settings of their own */
        get: operations["listMappingUnits"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/mappings/units/{unit}": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @description Modbus unit, 2 to 254 */
                unit: string;
            };
            cookie?: never;
        };
        get?: never;
        /** How a unit answers where nothing is mapped */
        put: operations["changeMappingUnit"];
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/mappings/template": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        get?: never;
        put?: never;
        /** Adds a block of mappings for an axis */
        post: operations["addMappingTemplate"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/events": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Alarms, writes, commands, line, presence and site changes; oldest first
         * @description If there are more than `limit`, the newest ones; with `order=oldest` the oldest ones. Ids count up without gaps. What was done before the question is in the answer.
         */
        get: operations["listEvents"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/alarms": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * What is wrong, or was and nobody has acknowledged it; unacknowledged active ones first, then newest first
         * @description In the words of ISA-18.2. One alarm is one (axis, drive or line; kind; code), however often it comes. It is raised by an event of
         *     severity alarm, by a line that is down and by a drive that is silent; it is cleared when the fault is cleared, the line is up, the
         *     drive answers, or when what it is about leaves the site. What nothing takes back is cleared at once and waits to be acknowledged.
         *     Cleared and acknowledged, it leaves the list; what happened stays in the events. The list is kept over a restart. At most 1000
         *     alarms: then the one that was cleared first goes. The live feed's topic `alarms` carries the same document when it changes.
         */
        get: operations["listAlarms"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/alarms/acknowledge": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        get?: never;
        put?: never;
        /** Acknowledges several alarms, all or none; `all` are those that are neither acknowledged nor shelved. Needs the role operator */
        post: operations["acknowledgeAlarms"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/alarms/{alarm}/acknowledge": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /**
                 * @description number of an alarm of the list
                 * @example 12
                 */
                alarm: components["parameters"]["alarm"];
            };
            cookie?: never;
        };
        get?: never;
        put?: never;
        /** Somebody has seen this alarm; if it is cleared it leaves the list. Needs the role operator */
        post: operations["acknowledgeAlarm"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/alarms/{alarm}/shelve": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /**
                 * @description number of an alarm of the list
                 * @example 12
                 */
                alarm: components["parameters"]["alarm"];
            };
            cookie?: never;
        };
        get?: never;
        put?: never;
        /** Puts an alarm aside for a time, with a reason; then it is back by itself. Needs the role operator */
        post: operations["shelveAlarm"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/alarms/{alarm}/unshelve": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /**
                 * @description number of an alarm of the list
                 * @example 12
                 */
                alarm: components["parameters"]["alarm"];
            };
            cookie?: never;
        };
        get?: never;
        put?: never;
        /** Takes an alarm back from the shelf. Needs the role operator */
        post: operations["unshelveAlarm"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/stream": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * The live feed, a WebSocket (RFC 6455)
         * @description The client sends text messages `StreamRequest`; the gateway sends text messages `StreamMessage`, one topic each.
         *
         *     | Topic | `data` | When |
         *     |---|---|---|
         *     | `axes/NAME`, `axes/*` | `Axis`; its `age_ms` is of the moment `at` of the message | at once, then when it changed, at most once per period; when only `at` moved on, once per second; null when the axis was removed |
         *     | `drives/NAME`, `drives/*` | `Drive` | the same way, looked at every 250 ms at most |
         *     | `lines/NAME`, `lines/*` | `Line` | the same way, looked at every 250 ms at most |
         *     | `lines/NAME/frames` | `StreamFrames` | frames that crossed the line since, in one list per period |
         *     | `events` | `Event` | each event, as it happens |
         *     | `alarms` | `AlarmList` | at once, then when it changed, at most every 200 ms |
         *     | `recipes` | `RecipeReport` | of runs in progress at once, then of every run when it changed, at most every 100 ms, and at its end |
         *     | `site` | `{"revision": N}` | at once, then with each change of the site |
         *     | `error` | `StreamError` | the answer to a request that is wrong |
         *
         *     States (axes, drives, lines) are dropped for a newer one when the client reads slowly; events never: a client that falls
         *     more than 4096 events behind, or does not read for 15 s, is closed with 1013; one whose session or token has ended with 1008. Other codes: 1001 the gateway stops, 1002 protocol error,
         *     1003 binary or three messages in a row that are not a request, 1007 not UTF-8, 1008 no sign of life, 1009 message over 64 KiB.
         *     The gateway sends a ping every 20 s. A browser's `Origin` must be the gateway's own host.
         */
        get: operations["openStream"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/session": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** Who this request comes from */
        get: operations["getSession"];
        put?: never;
        /**
         * Sign in with a password
         * @description 401 has one text for a wrong user and a wrong password. After three wrong attempts the next ones have to wait, longer each time (429).
         */
        post: operations["signIn"];
        /** End this session */
        delete: operations["signOut"];
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/session/first": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        get?: never;
        put?: never;
        /** Make the first administrator, with the code that was printed when the gateway started for the first time */
        post: operations["firstSignIn"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/users": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** All users (administrator) */
        get: operations["listUsers"];
        put?: never;
        /** Make a user (administrator) */
        post: operations["addUser"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/users/{user}": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                user: string;
            };
            cookie?: never;
        };
        /** One user (administrator) */
        get: operations["getUser"];
        put?: never;
        post?: never;
        /** Remove a user, with his sessions and tokens (administrator) */
        delete: operations["removeUser"];
        options?: never;
        head?: never;
        /**
         * Change role, password or whether the user may sign in (administrator)
         * @description Ends the user's sessions. The last administrator that can sign in stays one (409).
         */
        patch: operations["changeUser"];
        trace?: never;
    };
    "/api/v1/users/{user}/password": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                user: string;
            };
            cookie?: never;
        };
        get?: never;
        /** Change one's own password, signed in with it */
        put: operations["changePassword"];
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/tokens": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** One's own tokens; an administrator sees all */
        get: operations["listTokens"];
        put?: never;
        /**
         * Make a token for a program; its secret is in this answer alone
         * @description For whoever is signed in with a password. The role is not above one's own; a token is worth no more than its owner is at that time. The name is the owner's alone once (409): by it events tell who did what.
         */
        post: operations["addToken"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/tokens/{token}": {
        parameters: {
            query?: never;
            header?: never;
            path: {
                token: string;
            };
            cookie?: never;
        };
        get?: never;
        put?: never;
        post?: never;
        /** Remove a token of one's own; an administrator removes any */
        delete: operations["removeToken"];
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
}
export type webhooks = Record<string, never>;
export interface components {
    schemas: {
        SnapshotInfo: {
            n: number;
            axis: string;
            name: string;
            comment: string;
            at: components["schemas"]["Time"];
            who: string | null;
            /** @description of the drive that it was taken of; null: taken by an older program, not known */
            family: string | null;
            values: number;
        };
        Snapshot: {
            n: number;
            axis: string;
            name: string;
            comment: string;
            at: components["schemas"]["Time"];
            who: string | null;
            /** @description of the drive that it was taken of; null: taken by an older program, not known */
            family: string | null;
            values: number;
            parameters: components["schemas"]["SnapshotValue"][];
            left_out?: string[];
            not_read?: components["schemas"]["WriteFailure"][];
        };
        SnapshotValue: {
            parameter: string;
            name: string | null;
            unit: string | null;
            value: components["schemas"]["MaybeValue"];
        };
        WriteFailure: {
            parameter: string;
            reason: string;
        };
        SnapshotRequest: {
            name: string;
            comment?: string;
            /**
             * @default device
             * @enum {string}
             */
            from?: "device" | "stored";
        };
        JobRunning: {
            state: string;
            text: string;
        };
        JobProgress: {
            /** @enum {string} */
            state: "none" | "running" | "done" | "failed";
            kind: string | null;
            done: number;
            of: number;
            text: string;
        };
        SnapshotDiff: {
            with: string;
            /** @description how many values the other side does not tell */
            not_known: number;
            /** @description why so, for people: an axis that was never read since the start says so; empty where there is nothing to say */
            text: string;
            rows: components["schemas"]["DiffRow"][];
            /** @description apart: what acts at once (`live` of a parameter) is no setting, and that it is another now is no difference */
            live: components["schemas"]["DiffRow"][];
        };
        DiffRow: {
            parameter: string;
            name: string | null;
            unit: string | null;
            snapshot: components["schemas"]["MaybeValue"];
            other: components["schemas"]["MaybeValue"];
            /** @description false: nobody said what it is there, so that it is neither the same nor another */
            other_known: boolean;
            same: boolean;
            writable: boolean;
        };
        RestoreRequest: {
            parameters?: string[];
            dry_run?: boolean;
            /**
             * @description also what the drive is reached by (`addressing` of a parameter); without it that is in `skipped`
             * @default false
             */
            include_addressing?: boolean;
            /**
             * @description also what acts at once instead of configuring (`live` of a parameter); without it that is in `skipped`
             * @default false
             */
            include_live?: boolean;
        };
        WriteReport: {
            dry_run: boolean;
            changes?: components["schemas"]["ValueChange"][];
            skipped: components["schemas"]["Skipped"][];
            changed?: components["schemas"]["WrittenValue"][];
            failed?: components["schemas"]["WriteFailure"][];
        };
        ValueChange: {
            parameter: string;
            from: components["schemas"]["MaybeValue"];
            to: components["schemas"]["MaybeValue"];
        };
        WrittenValue: {
            parameter: string;
            value: components["schemas"]["MaybeValue"];
        };
        Skipped: {
            parameter: string;
            why: string;
        };
        ParameterChange: {
            at: components["schemas"]["Time"];
            who: string | null;
            door: string | null;
            old: components["schemas"]["MaybeValue"];
            new: components["schemas"]["MaybeValue"];
        };
        Stage: {
            /** @enum {string} */
            state: "none" | "staged" | "applying" | "applied" | "rolling_back";
            /**
             * @description another one for each stage; `stage` of apply
             * @example k3f9Qa-2
             */
            id: string | null;
            /** @description who staged or applied it */
            by: string | null;
            /** @description the client that staged or applied it: the user or the host, with its X-Client */
            client: string | null;
            /** Format: date-time */
            staged_at: string | null;
            base_revision: number | null;
            revision: number;
            faults: components["schemas"]["Fault"][];
            diff: components["schemas"]["SiteDifference"][];
            /** @description axes that lose their connection by it, if only for a moment; those of them that move are stopped first */
            disturbs: string[];
            /** @description connections that applying it closes: those of EtherNet/IP whose own bytes would be others. All others live on. An owner's axes then do what their `fail_safe` says. null: the doors did not say in time */
            closes: components["schemas"]["ClientConnection"][] | null;
            /**
             * Format: date-time
             * @description until then it must be confirmed; only while it is on trial
             */
            confirm_by: string | null;
        };
        SiteDifference: {
            /** @enum {string} */
            kind: "added" | "removed" | "changed";
            what: string;
            before: Record<string, never> | null;
            after: Record<string, never> | null;
        };
        ApplyRequest: {
            /**
             * @description how long the trial lasts, s; 0 - for good, without a roll back
             * @default 60
             */
            confirm_within_s?: 0 | number;
            /** @description `id` of the stage that is meant: 409 `stage_replaced` if another one, or none, is staged now */
            stage?: string;
        };
        SiteRevision: {
            revision: number;
            at: components["schemas"]["Time"];
            who: string | null;
            bytes: number;
        };
        PendingBackup: {
            /** @description false: nothing waits, and all else is null */
            waiting: boolean;
            /**
             * Format: date-time
             * @description when it was laid down
             */
            at: string | null;
            /** @description by whom */
            who: string | null;
            /** @description its length */
            bytes: number | null;
            /** @description of the structure of its database; an older one is upgraded */
            version: number | null;
            /** @description of the site that comes in force with it */
            site_revision: number | null;
        };
        RestoreAnswer: {
            restart_needed: boolean;
            text: string;
        };
        Registers: {
            unit: number;
            table: string;
            address: number;
            count: number;
            words?: number[];
            bits?: boolean[];
            exception: Record<string, never> | null;
            decoded: components["schemas"]["DecodedRegister"][];
        };
        /**
         * @description Register 20 of an axis: why the last write over Modbus that concerned it was refused; register 21 counts them. The words are those of
         *     `reason` in `Problem`.
         *
         *     | Number | Reason | Exception | What it means |
         *     |---|---|---|---|
         *     | 0 | none | - | nothing was refused |
         *     | 1 | out_of_range | 3 | a value outside its type or range, or half of a 32-bit value |
         *     | 2 | unknown_point | 2 | no such register, parameter or element |
         *     | 3 | not_writable | 2 | it can only be read; the door is read-only (exception 1) |
         *     | 4 | wrong_state | 4 | the axis is not in a state for it: not enabled, fault, moving |
         *     | 5 | not_supported | 4 | this drive cannot do that; the function is switched off (exception 1) |
         *     | 6 | drive_refused | 4 | the drive answered with an error |
         *     | 7 | busy | 6 | a queue or the parameter channel is full |
         *     | 8 | line_down | 10 | the line is down, or the axis is not configured |
         *     | 9 | no_answer | 11 | the drive did not answer |
         *     | 10 | interrupted | 4 | another command, a stop or a fault ended it |
         *     | 11 | authority | 6 | another client holds the axis |
         *     | 12 | not_stored | 4 | the drive took it, but the database could not |
         *     | 13 | internal | 4 | a fault of the gateway itself |
         *
         *     The register list of the parameter channel (selector 48, request 50, state 51, value 52, error 54) and of the rest of an axis' block
         *     stands in `gateway/doors/modbus/README.md`; bit 31 of the selector asks for the value as an IEEE 754 single.
         */
        RefusalReason: number;
        DecodedRegister: {
            address: number;
            name?: string;
            mapping?: string;
            type: string;
            value: components["schemas"]["MaybeValue"];
            unit: string | null;
            /** @description for people; of `refusal_reason` the word of `RefusalReason` */
            text: string;
        };
        Place: {
            address: number;
        };
        TemplateRequest: {
            /** @enum {string} */
            template: "standard_map";
            axis: string;
            unit: number;
            /** @description left out: the next multiple of 64 with 64 free registers */
            address?: number;
            dry_run?: boolean;
        };
        TemplateAnswer: {
            dry_run: boolean;
            mappings: components["schemas"]["Mapping"][];
        };
        /**
         * @default 0
         * @enum {string}
         */
        Flag: "0" | "1" | "true" | "false";
        /**
         * Format: date-time
         * @description RFC 3339, UTC, with a fraction
         * @example 2026-01-02T03:04:05.678901Z
         */
        Time: string;
        /** @description null, and only null */
        Nothing: Record<string, never> | null;
        /** @enum {string} */
        Severity: "info" | "warning" | "alarm";
        /** @description a truth, a number or a text; bytes are a text of hex pairs */
        Value: boolean | number | string;
        /** @description a value, or null where none is known */
        MaybeValue: (boolean | null) | (number | null) | (string | null);
        /** @description the family's own options, as `options` of the family lists them */
        FamilyOptions: {
            [key: string]: string | number | boolean;
        };
        Fault: {
            /**
             * @description JSON pointer to the place
             * @example /axes/2/number
             */
            pointer: string;
            /**
             * @description what the pointer points into, the body of the request or the site that would result
             * @enum {string}
             */
            document: "body" | "site";
            /** @description what is wrong */
            text: string;
            /** @description what to do */
            remedy: string;
        };
        Problem: {
            /** @description `stage_replaced`: the id of the stage that is there now; null if none is */
            stage?: string | null;
            /** @description of 412: what is there now: the site in force; the recipe, null if there is none any more; the user; the Modbus door; the last write of a parameter, null if nobody wrote it */
            current?: Record<string, never> | null;
            /** @description of 412: the ETag of what is there now */
            etag?: string | null;
            /** @description of 412 for the site: what became of it since the revision that was meant; null if the history does not have that one any more */
            changes?: components["schemas"]["SiteDifference"][] | null;
            /** @description how many parameters were read before the drive fell silent */
            read?: number;
            /** @description of a native exchange: the error that the drive answered with */
            reply_hex?: string;
            /** @description of a native exchange that the drive answered with an error */
            took_ms?: number;
            dry_run?: boolean;
            changed?: components["schemas"]["WrittenValue"][];
            failed?: components["schemas"]["WriteFailure"][];
            skipped?: components["schemas"]["Skipped"][];
            /**
             * @description `urn:axisgate:problem:` and the reason
             * @example urn:axisgate:problem:not_found
             */
            type: string;
            title: string;
            status: number;
            /** @description what happened, to what, why, what to do */
            detail: string;
            /** @description the request target */
            instance?: string;
            /** @description the drive's own error code, where it has one */
            code: number | null;
            /**
             * @description a stable word. From drives and the engine: out_of_range, unknown_point, not_writable, wrong_state, not_supported,
             *     drive_refused, busy, line_down, no_answer, interrupted, authority, not_stored, internal. From this door: bad_request,
             *     forbidden, not_found, method_not_allowed, not_acceptable, time_out, conflict, precondition_failed,
             *     precondition_required, too_large, unsupported_media_type, misdirected, invalid, upgrade_required, headers_too_large,
             *     not_simulated, not_ready
             */
            reason: string;
            /** @description the axis, where one is concerned */
            axis?: string;
            /** @description where a command is concerned: null if nothing was sent */
            ticket?: number | null;
            /**
             * @description where a command is concerned
             * @enum {string}
             */
            result?: "refused" | "failed";
            /** @description the command, where one is concerned */
            command?: string;
            faults?: components["schemas"]["Fault"][];
            /** @description beside those in `faults`; there wherever `faults` is */
            more_faults?: number;
        };
        CommandProblem: components["schemas"]["Problem"] & {
            /** @description null if nothing was sent */
            ticket?: number | null;
            /** @enum {string} */
            result?: "refused" | "failed";
            command?: string;
        };
        NotReady: components["schemas"]["Problem"] & components["schemas"]["Ready"];
        Health: {
            /** @enum {string} */
            status: "ok";
            uptime_s: number;
        };
        Ready: {
            ready: boolean;
            missing: string[];
        };
        About: {
            /** @enum {string} */
            name: "axisgate";
            version: string;
            /** @enum {string} */
            api: "/api/v1";
            uptime_s: number;
            now: components["schemas"]["Time"];
            site_revision: number;
            families: string[];
            doors: {
                name: string;
                address: string;
            }[];
            /** @description how many */
            lines: number;
            /** @description how many */
            drives: number;
            /** @description how many */
            axes: number;
        };
        /** @description the members below, and whatever else the family's catalogue says of the whole family */
        Family: {
            /** @example uim342 */
            name: string;
            /** @description family number of register 15 */
            number: number;
            /** @description speaks CAN frames */
            uses_can: boolean;
            /** @description speaks on a byte line (serial or TCP) */
            uses_bytes: boolean;
            factory_address: string;
            default_bit_rate: number | null;
            /**
             * @description of a serial line
             * @example 8N1
             */
            default_format: string | null;
            /** @description how many */
            parameters: number;
            /** @description how many */
            commands: number;
            /** @description how many */
            errors: number;
            /** @description what `options` of a line or drive may say; a twin's stand beside those of its drive, or of its line for all twins of that. What is not in this list, or not in its range, is an event and counts as not given */
            options?: {
                /** @example crc */
                name: string;
                of: ("line" | "drive" | "twin")[];
                /** @description the only ones; without them min and max decide, and without those it is a text that the description explains */
                values?: string[];
                min?: number;
                max?: number;
                unit?: string;
                /** @description null where the description says what holds */
                default: string | null;
                description: string;
            }[];
        } & {
            [key: string]: unknown;
        };
        Parameter: {
            /** @description as the manual writes it */
            id: string;
            /** @description snake_case */
            name: string;
            group: string;
            /** @enum {string} */
            type: "bool" | "u8" | "i8" | "u16" | "i16" | "i24" | "u32" | "i32" | "i64" | "f32" | "f64" | "text" | "bytes";
            unit: string | null;
            min: number | null;
            max: number | null;
            default: components["schemas"]["MaybeValue"];
            /** @enum {string} */
            access: "R" | "W" | "RW";
            storage: string | null;
            /** @description the drive is reached by it (address, name, group, speed or form of its line): snapshots and tables are written back without it unless they say include_addressing */
            addressing: boolean;
            /** @description it acts at once instead of configuring (a switch, set-point, counter, selector, output, latched status, or a variable of the program in the drive): snapshots and tables are written back without it unless they say include_live, and comparisons show it apart */
            live: boolean;
            description: string;
            /** @description the only values that are allowed, with their meaning; null where min and max decide */
            allowed: {
                value: number;
                meaning: string;
            }[] | null;
            /** @description of a number whose bits mean something by themselves, its parts; a write that has another value than the allowed ones in a part is refused before the drive is asked; null where it has none */
            fields: {
                /** @description snake_case */
                name: string;
                low_bit: number;
                bits: number;
                /** @description the only values of this part; null means all that its bits hold */
                allowed: {
                    value: number;
                    meaning: string;
                }[] | null;
            }[] | null;
            /** @description what ranges of values mean */
            meanings: {
                from: number;
                through: number;
                meaning: string;
            }[] | null;
            alternate: components["schemas"]["AlternateForm"];
            /** @description members of this entry that the maker's manual does not print and that were decided here */
            choice: string[];
            /** @description of an array, the number of its first element */
            first: number | null;
            /** @description of an array, how many elements */
            count: number | null;
            /** @description what the Modbus parameter channel knows the parameter by (written to registers 48 and 49 of an axis as u32); of an array, that of its first element: each further one is 65536 more; null: texts and bytes are not carried there */
            selector: number | null;
        };
        /** @description unit and range while another parameter has a certain value; with `parameter` null, of what is written, where reading gives more. Of an axis, `unit`, `min` and `max` beside it are those that hold now, as far as that other parameter has been read */
        AlternateForm: {
            parameter: string | null;
            equals: number | null;
            unit: string | null;
            min: number;
            max: number;
        } | null;
        CatalogueCommand: {
            id: string;
            name: string;
            description: string | null;
            /**
             * @description by what an action of this name is complete; until then it is accepted, and never done
             * @enum {string}
             */
            completes: "acknowledged" | "target_reached" | "standstill" | "powered" | "online_again" | "reported";
            /**
             * @description what is lost or begins by it, in sentences to ask a person with before it is sent; the API itself does not ask; null: it does no harm
             * @example All settings of the drive go back to the values of the factory.
             */
            confirm: string | null;
            /** @description what it takes by name; empty where it takes none, or one text */
            arguments: components["schemas"]["CommandArgument"][];
        };
        CommandArgument: {
            name: string;
            /**
             * @description of the drive's count
             * @example i32
             */
            type: string;
            /** @example mm */
            unit: string | null;
            /**
             * @description units per count of the drive; what is given is rounded to a count
             * @example 0.0001
             */
            scale: number;
            /** @description null: what the type holds */
            min: number | null;
            max: number | null;
            default: components["schemas"]["MaybeValue"];
            description: string | null;
        };
        ErrorCode: {
            code: number;
            /** @description of a class of codes that the manual does not list one by one, the last; null: `code` alone */
            through: number | null;
            /** @example alarm */
            kind: string | null;
            name: string | null;
            text: string | null;
            cause: string | null;
            remedy: string | null;
        };
        /** @description how one talks on the line; what is left out is the family's default */
        LineTiming: {
            reply_timeout_ms?: number;
            poll_period_ms?: number;
            pause_ms?: number;
            stale_after_ms?: number;
            retries?: number;
            silent_limit?: number;
            retry_pause_min_ms?: number;
            retry_pause_max_ms?: number;
        };
        LineFields: {
            name?: components["schemas"]["Name"];
            /** @description can:can0, serial:/dev/ttyUSB0?baud=9600&format=7N1&rs485=1, tcp:HOST:PORT, tcp-listen:HOST:PORT, udp:HOST:PORT, udp-listen:HOST:PORT, pty:PATH, pty:PATH?baud=9600&format=7N1, dds (axes of other gateways), twin */
            uri?: string;
            /** @description of the drives that name none; may be left out on a CAN line */
            family?: string;
            /** @description bit/s; left out or 0 - from the URI or the family's default */
            bitrate?: number;
            options?: components["schemas"]["FamilyOptions"];
            timing?: components["schemas"]["LineTiming"];
            /**
             * @deprecated
             * @description the word for timing in earlier versions
             */
            manners?: components["schemas"]["LineTiming"];
        };
        /** @description 1 to 64 letters, digits, - _ and . ; not "." or "..", which no path can name */
        Name: string;
        /**
         * @description 1 to 64 letters, digits, - _ and . ; the first one is a letter or digit. One that a site has from before this rule stays until it is changed
         * @example feeder
         */
        AxisName: string;
        LineSpec: components["schemas"]["LineFields"] & Record<string, never>;
        /** @description a whole line; `name` may be left out, and `status` and `drives` are ignored */
        LineChange: components["schemas"]["LineFields"] & Record<string, never>;
        /** @description the members of `LineFields` that change; null removes one */
        LinePatch: Record<string, never>;
        LineStatus: {
            /** @enum {string} */
            state: "closed" | "opening" | "up" | "down" | "bus_off";
            /** @description for people */
            text: string;
            frames_in: number;
            frames_out: number;
            bytes_in: number;
            bytes_out: number;
            /** @description frames that found the queue full */
            dropped: number;
            errors: number;
            /** @description times the line came back */
            reopened: number;
            /** @description frames waiting now */
            queued: number;
            /** @description share of the bit rate used in the last second */
            load: number;
            /** @description the CAN controller's counter */
            tx_errors: number;
            /** @description the CAN controller's counter */
            rx_errors: number;
        };
        Line: components["schemas"]["LineFields"] & {
            readonly drives: string[];
            readonly status: components["schemas"]["LineStatus"] & {
                counters: components["schemas"]["LineCounters"];
                /** @description what was counted while a scan ran, polls of the site's own drives among it; not in `counters` */
                scan_counters: components["schemas"]["LineCounters"];
                /** @description what each family's protocol counted; `counters` is their sum */
                families: {
                    family: string;
                    counters: components["schemas"]["LineCounters"];
                }[];
                /** @description CAN frames that arrived with identifiers of none of the line's families */
                unclaimed: number;
                /** @description some drives of the line are simulated now */
                has_twin_bus: boolean;
                /** @description the bus of the simulated drives; null if there is none */
                twin: components["schemas"]["LineStatus"] | components["schemas"]["Nothing"];
            };
        };
        /** @description what the protocol counted on the line */
        LineCounters: {
            exchanges: number;
            timeouts: number;
            retries: number;
            refused: number;
            garbled: number;
            unexpected: number;
        };
        DriveFields: {
            name?: components["schemas"]["Name"];
            line?: string;
            /** @description left out in a request, or its line's: the line's, also when that changes. Several families can share a CAN line */
            family?: string;
            /** @description number or text, in the family's own form; left out in a request - the factory address */
            address?: number | string;
            /**
             * @description device - the real one only; twin - the embedded model only; auto - the real one if it answers, else the twin
             * @enum {string}
             */
            presence?: "device" | "twin" | "auto";
            options?: components["schemas"]["FamilyOptions"];
            /** @description name of the maker's description that is the drive's catalogue (family cia402) */
            description?: components["schemas"]["DescriptionName"];
        };
        /** @example maker-model-1.eds */
        DescriptionName: string;
        /** @description what the file does not say is null */
        DescriptionEntry: {
            name: components["schemas"]["DescriptionName"];
            bytes: number;
            /** Format: date-time */
            added_at: string;
            added_by: string | null;
            vendor: string | null;
            /** @description as 1018h:01 of the drive */
            vendor_number: number | null;
            product: string | null;
            /** @description as 1018h:02 */
            product_number: number | null;
            /** @description as 1018h:03 */
            revision_number: number | null;
            order_code: string | null;
            bit_rates_kbit: number[];
            objects: number;
            /** @description subindices of all objects, a variable counted as one */
            entries: number;
            /** @description drives that name it */
            used_by: string[];
        };
        Description: components["schemas"]["DescriptionEntry"] & {
            /** @description PDOs as the file has them mapped; the gateway maps its own when the drive boots */
            pdos: {
                /**
                 * @description as the drive sees it
                 * @enum {string}
                 */
                direction: "receive" | "transmit";
                number: number;
                mapped: {
                    /** @example 6040h */
                    object: string;
                    name: string | null;
                    bits: number;
                }[];
            }[];
            /** @description what is odd in the file and can be used all the same */
            warnings: {
                line: number;
                text: string;
            }[];
        };
        DriveSpec: components["schemas"]["DriveFields"] & Record<string, never>;
        /** @description a whole drive; `name` may be left out, and `axes` and `status` are ignored */
        DriveChange: components["schemas"]["DriveFields"] & Record<string, never>;
        /** @description the members of `DriveFields` that change; null removes one */
        DrivePatch: Record<string, never>;
        DriveStatus: {
            /**
             * @description who serves the axes now
             * @enum {string}
             */
            presence: "offline" | "device" | "twin";
            /** @description somebody serves them */
            online: boolean;
            simulated: boolean;
            /** @description the real drive answers */
            device_online: boolean;
            /** @description why it is so, for people */
            text: string;
            silent_exchanges: number;
            retry_pause_ms: number;
            sync: components["schemas"]["DriveSync"];
        };
        /** @description how its axes tell of themselves where the line has a SYNC; null: they are asked */
        DriveSync: {
            /** @description between two SYNCs while something moves; at rest they are further apart */
            beat_ms: number;
            /** @description the axes tell at each so many SYNCs */
            turns: number;
            /** @description of its axes: beat_ms x turns */
            cycle_ms: number;
        } | null;
        Drive: components["schemas"]["DriveFields"] & {
            readonly axes: string[];
            readonly status: components["schemas"]["DriveStatus"];
        };
        AxisFields: {
            name?: components["schemas"]["AxisName"];
            drive?: string;
            /**
             * @description axis within the drive
             * @default 1
             */
            channel?: number;
            /** @description place in the register map */
            number?: number;
            /** @description for people, such as mm or deg; empty: increments */
            unit?: string;
            /** @default 1 */
            increments_per_unit?: number;
            /** @description software limit of the gateway, in `unit` */
            position_min?: number;
            /** @description software limit of the gateway, in `unit` */
            position_max?: number;
            /** @description unit/s */
            velocity_max?: number;
            /** @description unit/s^2 */
            acceleration_max?: number;
            /** @description unit/s^2: the weakest ramp that the drive may brake with, for the limits of position where the drive does not tell its own */
            deceleration_min?: number;
            /**
             * @description native statements and actions that may begin a motion which cannot be read beforehand. Left out: allow
             * @enum {string}
             */
            unread_statements?: "allow" | "refuse";
            fail_safe?: components["schemas"]["FailSafe"];
            /**
             * @description the machine part that it belongs to, for people; left out: none
             * @example infeed
             */
            group?: string;
            /** @description its trends are kept on the disk too and outlive a restart, within the host's `[recorder] trend_disk_mb`. Left out: false */
            trend_on_disk?: boolean;
            /**
             * @description lease: a command takes the axis for a while
             * @enum {string}
             */
            authority_mode?: "free" | "lease";
            /**
             * @description when the drive answers, what was written through the gateway is compared with what it has: a difference is an event (compare), and is written unless the axis moves (write). Left out: ignore
             * @enum {string}
             */
            stored_parameters?: "ignore" | "compare" | "write";
        };
        /** @description what happens to the axis when the client that commands it is lost. What is left out: a velocity move is halted, a motion to a target goes on to it. What is given holds for every motion, and `disable` for an enabled axis at rest as well */
        FailSafe: {
            modbus_closed?: components["schemas"]["FailSafeAction"];
            modbus_silent?: components["schemas"]["FailSafeAction"];
            set_points_silent?: components["schemas"]["FailSafeAction"];
            lease_ended?: components["schemas"]["FailSafeAction"];
            enip_closed?: components["schemas"]["FailSafeAction"];
            enip_timed_out?: components["schemas"]["FailSafeAction"];
            enip_idle?: components["schemas"]["FailSafeAction"];
            line_lost?: components["schemas"]["FailSafeAction"];
            gateway_ends?: components["schemas"]["FailSafeAction"];
            dds_deadline?: components["schemas"]["FailSafeAction"];
            enip_session_closed?: components["schemas"]["FailSafeAction"];
            enip_silent?: components["schemas"]["FailSafeAction"];
            motion_unowned?: components["schemas"]["FailSafeAction"];
            /** @description how long a connected Modbus client may ask nothing; 0: for ever; left out: [modbus] watchdog_ms */
            watchdog_ms?: number;
        };
        /** @enum {string} */
        FailSafeAction: "nothing" | "halt" | "quick_stop" | "disable";
        /**
         * @description null: the default
         * @enum {string|null}
         */
        FailSafeWish: "nothing" | "halt" | "quick_stop" | "disable" | null;
        /** @description as `fail_safe` of the axis in the site, with null for what it does not name */
        FailSafeChoice: {
            modbus_closed?: components["schemas"]["FailSafeWish"];
            modbus_silent?: components["schemas"]["FailSafeWish"];
            set_points_silent?: components["schemas"]["FailSafeWish"];
            lease_ended?: components["schemas"]["FailSafeWish"];
            enip_closed?: components["schemas"]["FailSafeWish"];
            enip_timed_out?: components["schemas"]["FailSafeWish"];
            enip_idle?: components["schemas"]["FailSafeWish"];
            line_lost?: components["schemas"]["FailSafeWish"];
            gateway_ends?: components["schemas"]["FailSafeWish"];
            dds_deadline?: components["schemas"]["FailSafeWish"];
            enip_session_closed?: components["schemas"]["FailSafeWish"];
            enip_silent?: components["schemas"]["FailSafeWish"];
            motion_unowned?: components["schemas"]["FailSafeWish"];
            watchdog_ms?: number | null;
        };
        FailSafeRow: {
            axis: string;
            fail_safe: components["schemas"]["FailSafeChoice"];
            /** @description for how long a connected Modbus client may ask nothing, and one that commands by EtherNet/IP messages may send nothing; 0: for ever */
            watchdog_ms_in_force: number;
            /** @description why the gateway stopped the axis without a command, until the next command to it */
            last_cause: string | null;
            drive_watchdog: components["schemas"]["DriveWatchdog"];
            drive_limits: components["schemas"]["DriveLimits"];
        };
        /** @description the software limits of position that the drive of the axis keeps by itself, written from the site's */
        DriveLimits: {
            /** @description the gateway writes them into drives of its family */
            available: boolean;
            /** @description the site limits the axis */
            wanted: boolean;
            /**
             * @description armed: written for each axis of the drive that the site limits, and acknowledged; off: option drive_limits of the drive; refused: this drive does not take them; null: none were written, or it has not been set up yet
             * @enum {string|null}
             */
            state: "armed" | "off" | "refused" | null;
            /** @description what the drive has answered; null: it is not refused */
            refusal: string | null;
            /** @description by what, or why there are none */
            description: string;
        };
        /** @description what the drive of the axis does by itself when it does not hear the gateway any more */
        DriveWatchdog: {
            /** @description drives of its family have one */
            available: boolean;
            /**
             * @description armed: programmed, and acknowledged by the drive; off: by the site; refused: this drive does not take it; null: it has none, or has not been set up yet
             * @enum {string|null}
             */
            state: "armed" | "off" | "refused" | null;
            /** @description of silence, after which it acts; null: it is not armed */
            time_ms: number | null;
            /**
             * @description null: it is not armed
             * @enum {string|null}
             */
            action: "quick_stop" | "disable" | "fault" | null;
            /** @description by what, or why there is none */
            description: string;
        };
        FailSafeMatrix: {
            causes: {
                /** @enum {string} */
                cause: "modbus_closed" | "modbus_silent" | "set_points_silent" | "lease_ended" | "enip_closed" | "enip_timed_out" | "enip_idle" | "line_lost" | "gateway_ends" | "dds_deadline" | "enip_session_closed" | "enip_silent" | "motion_unowned";
                /** @description as register 22 of the axis has it */
                number: number;
                description: string;
                default_endless: components["schemas"]["FailSafeAction"];
                default_to_a_target: components["schemas"]["FailSafeAction"];
            }[];
            axes: components["schemas"]["FailSafeRow"][];
        };
        /** @enum {string} */
        RehearsalStep: "second_client" | "refused_commands" | "gateway_restart" | "old_image";
        /** @description times in ms from the loss; for silence, a lease and a lost drive from the last that was heard */
        FailSafeCell: {
            axis: string;
            /**
             * @description gateway_gone: without a word, by a kill or for want of supply; what the drive does then, which nobody tells anything. gateway_restarts: the same, and another gateway is there 3 s later
             * @enum {string}
             */
            cause: "modbus_closed" | "modbus_silent" | "set_points_silent" | "lease_ended" | "enip_closed" | "enip_timed_out" | "enip_idle" | "line_lost" | "gateway_ends" | "dds_deadline" | "enip_session_closed" | "enip_silent" | "motion_unowned" | "gateway_gone" | "gateway_restarts";
            /** @description what the site names; null: the default */
            chosen: string | null;
            taken: components["schemas"]["FailSafeAction"];
            /** @description velocity, position or set_points: what the axis did at the loss */
            motion: string;
            /** @description unit/s at the loss */
            speed: number;
            /** @description the gateway acted; null: it did not */
            noticed_ms: number | null;
            /** @description the motor was a tenth slower */
            reaction_ms: number | null;
            /** @description it stood; null: it still moved when watching ended */
            standstill_ms: number | null;
            watched_ms: number;
            /** @description from the loss on, in `unit` */
            travel: number;
            /**
             * @description what really ended the motion: the cause for which the gateway acted; `supervisor`: it stopped what it saw; `target`: it has arrived; `drive`: by itself; a step: that disturbed it before the loss. null: it went on. Not in reports of older programs
             * @enum {string|null}
             */
            ended_by?: "modbus_closed" | "modbus_silent" | "set_points_silent" | "lease_ended" | "enip_closed" | "enip_timed_out" | "enip_idle" | "line_lost" | "gateway_ends" | "dds_deadline" | "enip_session_closed" | "enip_silent" | "motion_unowned" | "supervisor" | "target" | "drive" | "second_client" | "refused_commands" | null;
            /** @description it moved when its client came back with its old image; null: it did not come, or has none. Not in reports of older programs */
            moved_again?: boolean | null;
            /** @description the same in words */
            text: string;
        };
        FailSafeRehearsal: {
            /** @enum {string} */
            state: "none" | "running" | "done";
            done: number;
            total: number;
            report: {
                /** Format: date-time */
                at: string;
                /** Format: date-time */
                ended_at: string;
                who: string;
                site_revision: number;
                /** @description what it was played on */
                on: string;
                /** @description what was played beside the loss; not in reports of older programs */
                steps?: components["schemas"]["RehearsalStep"][];
                without_figures: number;
                /** @description axes whose drives follow no streamed set-points */
                without_set_points: string[];
                cells: components["schemas"]["FailSafeCell"][];
            } | null;
        };
        AxisSpec: components["schemas"]["AxisFields"] & Record<string, never>;
        /** @description a whole axis; `name` may be left out, and the members that only tell the state are ignored */
        AxisChange: components["schemas"]["AxisFields"] & Record<string, never>;
        /** @description the members of `AxisFields` that change; null removes one */
        AxisPatch: Record<string, never>;
        AxisError: {
            /** @description the drive's own, 0 for none */
            code: number;
            /** @description empty for none */
            text: string;
        };
        /** @description set-points that a client streams over `/stream` or another cyclic door */
        StreamedSetPoints: {
            streaming: boolean;
            /**
             * @description null while nobody streams
             * @enum {string|null}
             */
            mode: "position" | "velocity" | "torque" | null;
            /** @description handed to the drive since the start; counts up */
            taken: number;
            /** @description not handed to it; counts up */
            refused: number;
            /** @description why the newest one was not handed to the drive, or why the stream ended, as in a Result; null - it was, or none came yet */
            reason: string | null;
        };
        AxisState: {
            readonly line: string;
            readonly family: string;
            /** @description the drive or its twin answers */
            readonly online: boolean;
            /** @description the twin answers */
            readonly simulated: boolean;
            /** @description the data is too old to be trusted */
            readonly stale: boolean;
            /** @enum {string} */
            readonly presence: "offline" | "device" | "twin";
            /**
             * @description CiA 402 state, from the status word
             * @enum {string}
             */
            readonly state: "not_ready_to_switch_on" | "switch_on_disabled" | "ready_to_switch_on" | "switched_on" | "operation_enabled" | "quick_stop_active" | "fault_reaction_active" | "fault";
            /** @description CiA 402, with bit 8 simulated, 14 stale, 15 referenced */
            readonly statusword: number;
            /** @description as last accepted */
            readonly controlword: number;
            /** @enum {string} */
            readonly mode: "none" | "profile_position" | "profile_velocity" | "profile_torque" | "homing" | "interpolated_position" | "cyclic_position" | "cyclic_velocity" | "cyclic_torque" | "other";
            /** @description modes of operation display */
            readonly mode_number: number;
            /** @description the CiA 402 modes of operation that the drive offers; 8, 9 and 10 by streamed set-points alone */
            readonly modes: number[];
            readonly set_points: components["schemas"]["StreamedSetPoints"];
            readonly moving: boolean;
            readonly target_reached: boolean;
            /** @description the position has a known zero */
            readonly referenced: boolean;
            readonly fault: boolean;
            readonly warning: boolean;
            /** @description status word bit 11 */
            readonly internal_limit: boolean;
            /**
             * @description why the gateway stopped the axis without a command, until the next command to it; null - it did not
             * @enum {string|null}
             */
            readonly fail_safe_cause: "modbus_closed" | "modbus_silent" | "set_points_silent" | "lease_ended" | "enip_closed" | "enip_timed_out" | "enip_idle" | "line_lost" | "gateway_ends" | "dds_deadline" | "enip_session_closed" | "enip_silent" | "motion_unowned" | null;
            /** @description register 23: bit 0 latched, 1 by a fail-safe or a limit, 2 by another client, 3 by a safe input. While it is latched, words that a controller merely repeats do not move the axis */
            readonly stop_latch: number;
            /** @description the client whose stop is latched, as `last_commander` names it; null - it is none of a client, or nothing is latched */
            readonly stop_latch_by: string | null;
            /** @description who has stopped the axis and what moves it again; null - it is not latched */
            readonly stop_latch_text: string | null;
            /** @description in `unit`; null until the drive has said it */
            readonly position: number | null;
            /** @description whether somebody says where the axis should be now; if not, position_demand and following_error are null */
            readonly demand_known: boolean;
            /**
             * @description whose word the demand is: the drive tells it, or how far it is behind; computed: the gateway works it out from the order that the drive acknowledged (target, speed, ramps), so that a drive that plans otherwise shows a following error; open_loop: the position itself, because the drive counts the steps that it puts out and nothing measures whether the shaft follows; null: nobody can tell, because the axis is off, or moves by an order that this gateway did not give
             * @enum {string|null}
             */
            readonly demand_source: "drive" | "computed" | "open_loop" | null;
            /** @description where the axis should be now, in `unit` */
            readonly position_demand: number | null;
            /** @description demand less position, in `unit`; null without a demand and in open loop */
            readonly following_error: number | null;
            /** @description unit/s */
            readonly velocity: number | null;
            /** @description as last accepted */
            readonly target_position: number | null;
            /** @description unit/s, as last accepted */
            readonly target_velocity: number | null;
            readonly position_increments: number | null;
            readonly position_demand_increments: number | null;
            readonly following_error_increments: number | null;
            /** @description increments/s */
            readonly velocity_increments: number | null;
            readonly target_position_increments: number | null;
            readonly error: components["schemas"]["AxisError"];
            /** @description the drive's own status word(s) */
            readonly native: number;
            /**
             * @description who commands
             * @enum {string}
             */
            readonly authority: "none" | "modbus" | "ethernet_ip" | "http" | "dds" | "internal";
            /** @description the client that holds the axis; empty: nobody */
            readonly authority_holder?: string;
            /**
             * Format: date-time
             * @description end of its lease
             */
            readonly authority_until?: string | null;
            /** @description counts up */
            readonly setpoints_accepted: number;
            /**
             * Format: date-time
             * @description when the drive said it
             */
            readonly at: string | null;
            /** @description age of the data */
            readonly age_ms?: number | null;
        };
        Axis: components["schemas"]["AxisFields"] & components["schemas"]["AxisState"] & Record<string, never>;
        Command: components["schemas"]["SimpleCommand"] | components["schemas"]["HomeCommand"] | components["schemas"]["SetPositionCommand"] | components["schemas"]["MovePositionCommand"] | components["schemas"]["MoveVelocityCommand"];
        SimpleCommand: {
            /** @enum {string} */
            command: "enable" | "disable" | "quick_stop" | "halt" | "reset_fault";
        };
        HomeCommand: {
            /** @enum {string} */
            command: "home";
            /**
             * @description CiA 402 homing method; 0 - the drive's own
             * @default 0
             */
            method?: number;
        };
        SetPositionCommand: {
            /** @enum {string} */
            command: "set_position";
            /** @description what the present position shall be called, in `unit` */
            position: number;
        };
        MovePositionCommand: {
            /** @enum {string} */
            command: "move_absolute" | "move_relative";
            /** @description target, or distance, in `unit` */
            position: number;
            /** @description unit/s; left out - as the drive has it */
            velocity?: number;
            /** @description unit/s^2 */
            acceleration?: number;
            /** @description unit/s^2 */
            deceleration?: number;
            /**
             * @description load it; /api/v1/moves/start starts it
             * @default false
             */
            prepare?: boolean;
        };
        MoveVelocityCommand: {
            /** @enum {string} */
            command: "move_velocity";
            /** @description unit/s, signed */
            velocity: number;
            /** @description unit/s^2 */
            acceleration?: number;
            /** @description unit/s^2 */
            deceleration?: number;
            /**
             * @description load it; /api/v1/moves/start starts it
             * @default false
             */
            prepare?: boolean;
            /** @description dead-man time-out: the axis is halted when this has passed (50 ms more at most) without the same command from the same client again; a renewal costs the drive no exchange */
            hold_ms?: number;
            /**
             * @description with hold_ms: renews a held move and never starts one; 409 if it has ended
             * @default false
             */
            renew?: boolean;
        };
        Action: {
            name: string;
            /**
             * @description one text for the drive; where the command has typed arguments: name=value, blanks or commas between them
             * @default
             */
            argument?: string;
            /**
             * @description values by name, in the units of the catalogue's arguments; those with a default may be left out. Each one that is unknown, missing or outside its range is a fault of its own. Not together with argument.
             * @example {
             *       "position": 12.5,
             *       "velocity": 0.1
             *     }
             */
            arguments?: {
                [key: string]: string | number | boolean;
            };
        };
        MovesStart: {
            axes: string[];
        };
        CommandAnswer: {
            /** @description names this command; counts up */
            ticket: number;
            /** @enum {string} */
            result: "accepted" | "done";
            /** @description empty, or why it is not done yet */
            reason: string;
            axis: string;
            command: string;
            /** @description the drive's own, where it has one */
            code: number | null;
            /** @description what the drive or its adapter said beside; empty if nothing */
            text: string;
            value: components["schemas"]["MaybeValue"];
        };
        ParameterWrite: {
            value: components["schemas"]["Value"];
        };
        AxisParameter: components["schemas"]["Parameter"] & {
            value: components["schemas"]["MaybeValue"];
            /** @enum {string} */
            quality: "unknown" | "good" | "stale";
            /**
             * Format: date-time
             * @description when the drive said it
             */
            at: string | null;
            stored: components["schemas"]["MaybeValue"];
            previous: components["schemas"]["MaybeValue"];
            /**
             * Format: date-time
             * @description last write through the gateway
             */
            written_at: string | null;
            written_by: string | null;
            /** @description the door */
            written_through: string | null;
            /** @description why the value is stale, else empty */
            text: string;
            /** @description the value in words, where the catalogue has any */
            meaning: string | null;
            history?: {
                value: components["schemas"]["MaybeValue"];
                previous: components["schemas"]["MaybeValue"];
                written_at: components["schemas"]["Time"];
                written_by: string | null;
                written_through: string | null;
            }[];
        };
        /** @description one of the two */
        NativeRequest: {
            /** @description text in the drive's language; the family completes it (terminator, checksum, address) */
            send?: string;
            /** @description bytes as hex pairs, in the form of the family: mcode the line's characters, with CR, LF or CR LF at its end or without; pacontrol one whole frame, 01 02 to 04, or 04 alone; uim342 control word, length 0 to 8 and data, once to four times. What has not that form is refused with 422 */
            send_hex?: string;
        };
        NativeReply: {
            reply: string;
            reply_hex: string;
            /** @description milliseconds, with fractions */
            took_ms: number;
        };
        /**
         * @description outside conditions by name: power, silent, stall (booleans), inputs (bit mask), limit_positive, limit_negative, home_switch
         *     (booleans), temperature (deg C), inject_error (code; 0 clears), position (increments), load (0..1), and what a family adds
         */
        Hand: {
            [key: string]: components["schemas"]["MaybeValue"];
        };
        HandItem: {
            name: string;
            value: components["schemas"]["MaybeValue"];
            writable: boolean;
            description: string;
        };
        Frame: {
            sequence: number;
            at: components["schemas"]["Time"];
            to_drive: boolean;
            /** @description crossed the bus of the twins */
            simulated: boolean;
            /** @enum {string} */
            kind: "can" | "can_error" | "bytes";
            /** @description CAN identifier; null for bytes */
            id: number | null;
            extended: boolean;
            remote: boolean;
            /** @description hex pairs */
            data: string;
            /** @example 04280095#01 */
            text: string;
            /** @description what the frame says in the family's own words; none where a message is not whole yet, several where one run of bytes holds several */
            decoded: string[];
        };
        Trace: {
            line: string;
            /** @description asked for but overwritten */
            missed: number;
            /** @description `since` for the next request */
            next: number;
            frames: components["schemas"]["Frame"][];
        };
        /** @enum {string} */
        Role: "viewer" | "operator" | "engineer" | "administrator";
        SessionInfo: {
            /** @description null for local access and nobody */
            user: string | null;
            /** @enum {string|null} */
            role: "viewer" | "operator" | "engineer" | "administrator" | null;
            /** @enum {string} */
            via: "cookie" | "token" | "local" | "none";
            /** @description for X-CSRF-Token */
            csrf: string | null;
            /** Format: date-time */
            expires_at: string | null;
            /** @description why whoever asks is signed out, when he came with the cookie of a session that has ended; the answer takes the cookie away */
            ended: string | null;
            /** @description no user exists yet */
            first_sign_in: boolean;
            /** @description all roles, lowest first */
            roles: components["schemas"]["Role"][];
        };
        SignIn: {
            user: string;
            password: string;
        };
        FirstSignIn: {
            /** @example K7QF-2M9D-XW3E-8HTR */
            code: string;
            user: string;
            password: string;
        };
        User: {
            name: string;
            /** @description names this state of the user, for If-Match; a new password is another state, a sign-in is not */
            etag: string;
            role: components["schemas"]["Role"];
            enabled: boolean;
            created_at: components["schemas"]["Time"];
            /** Format: date-time */
            last_sign_in_at: string | null;
        };
        NewUser: {
            /** @description 1 to 64 of a-z, 0-9, . _ - @ */
            name: string;
            password: string;
            role: components["schemas"]["Role"];
            enabled?: boolean;
        };
        UserChange: {
            role?: components["schemas"]["Role"];
            enabled?: boolean;
            password?: string;
        };
        PasswordChange: {
            old: string;
            new: string;
        };
        Token: {
            id: string;
            name: string;
            role: components["schemas"]["Role"];
            owner: string;
            created_at: components["schemas"]["Time"];
            /** Format: date-time */
            expires_at: string | null;
            /**
             * Format: date-time
             * @description to the hour
             */
            last_used_at: string | null;
        };
        NewToken: {
            name: string;
            role: components["schemas"]["Role"];
            expires_in_s?: number | null;
        };
        MadeToken: components["schemas"]["Token"] & {
            /** @description the secret, shown once: Authorization: Bearer ... */
            token: string;
        };
        Authority: {
            axis: string;
            /** @enum {string} */
            door: "none" | "modbus" | "ethernet_ip" | "http" | "dds" | "internal";
            /** @description empty: nobody; a Modbus client is its address, whatever the number of its connections */
            holder: string;
            /** @description the holder in words, with his door and the connections that he has */
            holder_text: string;
            /** @description of a holder by Modbus, as address and port; empty for others, and in the answers of PUT and of hand-over */
            connections: string[];
            /** @enum {string} */
            mode: "free" | "lease";
            expires_in_s: number | null;
            /** Format: date-time */
            since: string | null;
            last_commander: string;
        };
        AuthorityList: {
            axes: components["schemas"]["Authority"][];
            /** @description who could be named as the next holder - clients of the last ten minutes that signed in or sent X-Client, and hosts connected by Modbus */
            clients: {
                /**
                 * @description as `to` of hand-over takes it
                 * @example http anne page-3f
                 */
                client: string;
                /** @enum {string} */
                door: "http" | "modbus";
                /**
                 * Format: date-time
                 * @description when it last asked for something; null for one that is connected
                 */
                at: string | null;
            }[];
        };
        TakeAuthority: {
            /** @default 30 */
            ttl_s?: number;
            /** @default false */
            take_over?: boolean;
        };
        HandOver: {
            /** @description a client of the list, or a user ("http anne"): then whichever client of that user comes first */
            to: string;
        };
        ModbusChange: {
            read_only: boolean;
        };
        ClientConnection: {
            /** @description the name of the door and a number; never used again while the gateway runs */
            id: string;
            /** @enum {string} */
            door: "modbus" | "enip";
            /** @enum {string} */
            kind: "modbus_tcp" | "session" | "messages" | "exclusive_owner" | "input_only" | "listen_only";
            /** @description address and port of the client */
            peer: string;
            /** Format: date-time */
            since: string;
            /**
             * Format: date-time
             * @description when something came by it last
             */
            received_at: string;
            /** @description axes that it owns: of an exclusive owner */
            axes: string[];
            /** @description its client has commanded by it; of an exclusive owner: it is in run mode */
            commands: boolean;
        };
        ModbusDoor: {
            bind: string;
            allow: string[];
            functions: number[];
            read_only: boolean;
            connections: {
                peer: string;
                requests: number;
                writes: number;
                exceptions: number;
                since: components["schemas"]["Time"];
                holds: string[];
            }[];
        };
        Event: {
            id: number;
            at: components["schemas"]["Time"];
            severity: components["schemas"]["Severity"];
            /** @description alarm, write, line, presence, site, command, refused (by any door), modbus_rtu (its port), input, snapshot, ... */
            kind: string;
            axis: string | null;
            drive: string | null;
            line: string | null;
            /** @description the drive's own */
            code: number | null;
            text: string;
            /** @description who and from where */
            who: string | null;
            door: string | null;
            parameter: string | null;
            old: string | null;
            new: string | null;
        };
        Alarm: {
            /** @description that of the event that raised it first; never given twice */
            id: number;
            axis: string | null;
            drive: string | null;
            line: string | null;
            /** @description of the event that raised it */
            kind: string;
            /** @description the drive's own */
            code: number | null;
            /** @description of the newest occurrence */
            text: string;
            severity: components["schemas"]["Severity"];
            /**
             * @description normal is only said of an alarm that has just left the list
             * @enum {string}
             */
            state: "unacknowledged_active" | "acknowledged_active" | "unacknowledged_cleared" | "shelved" | "normal";
            active: boolean;
            acknowledged: boolean;
            since: components["schemas"]["Time"];
            /** Format: date-time */
            cleared_at: string | null;
            acknowledged_by: string | null;
            /** Format: date-time */
            acknowledged_at: string | null;
            comment: string | null;
            /** Format: date-time */
            shelved_until: string | null;
            shelved_by: string | null;
            /** @description of the shelving */
            reason: string | null;
            /** @description how often it came */
            count: number;
        };
        /**
         * @description `unacknowledged` does not count shelved ones, as `unacknowledged` of the list; the others say one thing each, so that an alarm fits several
         * @enum {string}
         */
        AlarmFilter: "active" | "cleared" | "unacknowledged" | "acknowledged" | "shelved";
        AlarmList: {
            /** @description those that are not shelved */
            unacknowledged: number;
            /** @description alarms since the start that found 1000 active ones */
            dropped: number;
            alarms: components["schemas"]["Alarm"][];
        };
        /** @description either `ids` or `all` */
        AcknowledgeAlarms: {
            ids?: number[];
            /** @enum {boolean} */
            all?: true;
            comment?: string;
        };
        Site: {
            lines?: components["schemas"]["LineSpec"][];
            drives?: components["schemas"]["DriveSpec"][];
            axes?: components["schemas"]["AxisSpec"][];
            mappings?: components["schemas"]["MappingSpec"][];
            /** @description units that answer otherwise than the host's `[modbus]` section has it */
            modbus_units?: components["schemas"]["ModbusUnitSpec"][];
            /** @description units that speak another device's language, whatever drives are behind their axes */
            profiles?: components["schemas"]["ProfileSpec"][];
            /** @description EtherNet/IP assembly instances of the site's own */
            assemblies?: components["schemas"]["AssemblySpec"][];
        };
        /** @description A range of registers of a Modbus unit, served as an EtherNet/IP assembly instance. */
        AssemblySpec: {
            /** @description one that nothing else has; 100 to 140, 150 to 190, 197 to 199, 1041 to 2024 and 2041 to 3024 are taken */
            instance: number;
            direction: components["schemas"]["AssemblyDirection"];
            unit: number;
            /**
             * @default holding_registers
             * @enum {string}
             */
            table?: "holding_registers" | "input_registers";
            /** @default 0 */
            address?: number;
            /** @description two bytes each */
            registers: number;
            byte_order?: components["schemas"]["AssemblyOrder"];
            comment?: string;
        };
        /**
         * @description seen from the originator: input is what it reads
         * @enum {string}
         */
        AssemblyDirection: "input" | "output";
        /**
         * @description little_endian: each value with its lowest byte first, whatever the word order of its registers; registers: as Modbus carries them
         * @default little_endian
         * @enum {string}
         */
        AssemblyOrder: "little_endian" | "registers";
        /** @description as AssemblySpec; the instance is the path's */
        AssemblyEntry: {
            instance?: number;
            direction: components["schemas"]["AssemblyDirection"];
            unit: number;
            /** @enum {string} */
            table?: "holding_registers" | "input_registers";
            address?: number;
            registers: number;
            byte_order?: components["schemas"]["AssemblyOrder"];
            comment?: string;
        };
        Assemblies: {
            assemblies: components["schemas"]["Assembly"][];
            /** @description entries that a site may have */
            most: number;
        };
        Assembly: {
            instance: number;
            direction: components["schemas"]["AssemblyDirection"];
            unit: number;
            /** @enum {string} */
            table: "holding_registers" | "input_registers";
            address: number;
            registers: number;
            byte_order: components["schemas"]["AssemblyOrder"];
            comment?: string;
            bytes: number;
            /** @description as the EDS calls it */
            name: string;
            /** @description those that it shows, or commands */
            axes: string[];
            /** @description of an output: the input that the EDS opens with it */
            partner: number | null;
            /** @description it comes and goes with a profile and is changed there */
            of_profile: boolean;
            values: components["schemas"]["AssemblyValue"][];
        };
        AssemblyValue: {
            /** @description bytes, from 0 */
            offset: number;
            bytes: number;
            /** @description the point, or as the language has it */
            name: string;
            axis: string | null;
            type: string;
        };
        ProfileSpec: {
            /** @description one that has neither mappings nor another profile */
            unit: number;
            language: components["schemas"]["ProfileLanguage"];
            /**
             * @description of 32-bit values; left out: as the language has it
             * @enum {string|null}
             */
            word_order?: "high_first" | "low_first" | null;
            /** @description in the order in which the language numbers them; pacontrol takes up to eight, the others one */
            axes: components["schemas"]["ProfileAxisSpec"][];
            /** @description EtherNet/IP instance of what the language's master reads */
            input_assembly?: number | null;
            /** @description EtherNet/IP instance of what it writes */
            output_assembly?: number | null;
            /** @description lexium: instance of the classes that its manual prints */
            object_instance?: number | null;
        };
        FleetList: {
            /** @description this gateway is in a domain */
            enabled: boolean;
            gateways: components["schemas"]["FleetGateway"][];
        };
        /** @example crash-1 */
        RecordingName: string;
        RecordingChange: {
            name: components["schemas"]["RecordingName"];
        };
        /** @description null - at once */
        CaptureTrigger: {
            /**
             * @description level - the point crosses it; state - the flag comes (rising) or goes; command - one that moves is given to the axis
             * @enum {string}
             */
            kind: "at_once" | "level" | "state" | "command";
            /** @description one of the axes; left out - the first */
            axis?: string;
            /**
             * @default position
             * @enum {string}
             */
            point?: "position" | "velocity" | "demand" | "following_error";
            /** @description in units of the axis */
            level?: number;
            /** @enum {string} */
            state?: "moving" | "target_reached" | "fault" | "warning" | "referenced" | "online" | "fail_safe";
            /**
             * @default rising
             * @enum {string}
             */
            edge?: "rising" | "falling";
        } | null;
        CaptureWish: {
            name: components["schemas"]["RecordingName"];
            /** @description of one line */
            axes: string[];
            /**
             * @description wished; the line says what there is
             * @default 1000
             */
            rate_hz?: number;
            /** @default 200 */
            before_ms?: number;
            /**
             * @description 120 s together with before_ms, and 120,000 rows of all axes, at most
             * @default 1000
             */
            after_ms?: number;
            /**
             * @description for the trigger; then it is given up
             * @default 60000
             */
            wait_ms?: number;
            trigger?: components["schemas"]["CaptureTrigger"];
        };
        Capture: {
            name: components["schemas"]["RecordingName"];
            /** @enum {string} */
            state: "armed" | "triggered" | "done" | "cancelled";
            /** @description why it was cancelled, or ended early */
            why: string | null;
            who: string | null;
            armed_at: string | null;
            triggered_at: string | null;
            trigger: components["schemas"]["CaptureTrigger"];
            wanted_hz: number | null;
            before_ms: number | null;
            after_ms: number | null;
            wait_ms: number | null;
            axes: {
                axis: string;
                unit: string;
                rows: number;
                /** @description how often its drive told it; 0 - not known yet */
                rate_hz: number;
            }[];
            /** @description on the disk; 0 - not there (yet) */
            bytes: number;
            /** @description the file is cut off, altered or of another version, and not trusted */
            fault: string | null;
        };
        CaptureWithRows: components["schemas"]["Capture"] & {
            columns: {
                axis: string;
                unit: string;
                /** @description from the trigger on */
                seconds: number[];
                position: number[];
                velocity: number[];
                demand: (number | null)[];
                following_error: (number | null)[];
                statusword: number[];
            }[];
        };
        CaptureList: {
            disk_bytes: number;
            disk_most_bytes: number;
            /** @description why the last capture could not be written */
            disk_fault: string | null;
            captures: components["schemas"]["Capture"][];
        };
        Recording: {
            name: components["schemas"]["RecordingName"];
            /** @description when it was made */
            at: string | null;
            /** @description the stretch that it shows */
            from: string | null;
            to: string | null;
            bytes: number;
            why: string | null;
            who: string | null;
            /** @description of the program that made it */
            version: string | null;
            /** @description made by an alarm; the oldest of them make room for new ones */
            automatic: boolean;
            /** @description by `axisgate replay` */
            replayable: boolean;
            /** @description why not */
            not_replayable: string | null;
            /** @description the file is cut off, altered or of another version, and not trusted */
            fault: string | null;
        };
        Playback: {
            /** @description the stretch that it shows */
            from: string;
            to: string;
            at: string;
            axes: {
                [key: string]: unknown;
            }[];
            registers: {
                axis: string;
                /** @description of the first word in units 0 and 1 */
                address: number;
                words: number[];
            }[];
            frames: ({
                line: string;
                /** @description number of the command for which it was sent at once */
                command: number | null;
            } & {
                [key: string]: unknown;
            })[];
            /** @description commands, results, events; oldest first */
            happened: {
                at: string;
                kind: string;
                axis: string | null;
                /** @description number of a command and of its result; its frames carry the same */
                command: number | null;
                text: string;
            }[];
            curves: components["schemas"]["Trend"][];
        };
        RecordingList: {
            /** @description where the stretch begins that a recording made now would show */
            from: string | null;
            /** @description memory of that stretch */
            bytes: number;
            most_bytes: number;
            /** @description records that were lost on their way since the start */
            lost: number;
            /** @description a recording made now could be replayed */
            replayable: boolean;
            /** @description why not */
            not_replayable: string | null;
            trend_bytes: number;
            trend_most_bytes: number;
            trend_minutes: number;
            /** @description of all recordings */
            disk_bytes: number;
            disk_most_bytes: number;
            /** @description why the last recording could not be written */
            disk_fault: string | null;
            recordings: components["schemas"]["Recording"][];
        };
        Trends: {
            /** @description ms since 1970 */
            from: number;
            /** @description ms since 1970 */
            to: number;
            axes: components["schemas"]["Trend"][];
        };
        Trend: {
            axis: string;
            /** @description of position, demand and following error; velocity is in it per second */
            unit: string;
            /** @description how often its drive has told its position lately */
            rate_hz: number;
            /** @description true: each point has `first`, `min`, `max` and `last`; false: `values` */
            thinned: boolean;
            /** @description ms since 1970; of what is kept */
            oldest: number | null;
            /** @description ms since 1970; when it was known last, changed or not: it holds to here */
            newest: number | null;
            /** @description ms since 1970, one for each value; of a thinned stretch where its columns begin */
            at: number[];
            /** @description ms since 1970, of a thinned stretch: from here on `last` of the column holds, to the next column or to `newest` */
            until?: number[];
            /** @description of a thinned stretch - true: for a part of the column nothing was known */
            gaps?: boolean[];
            points: {
                position?: components["schemas"]["TrendPoint"];
                velocity?: components["schemas"]["TrendPoint"];
                demand?: components["schemas"]["TrendPoint"];
                following_error?: components["schemas"]["TrendPoint"];
                state?: {
                    values: string[];
                };
            };
        };
        /** @description null where nobody knows it */
        TrendPoint: {
            values?: (number | null)[];
            /** @description held when the column began */
            first?: (number | null)[];
            /** @description the smallest that was known in the column */
            min?: (number | null)[];
            /** @description the greatest that was known in the column */
            max?: (number | null)[];
            /** @description the newest of the column; it holds from `until` on */
            last?: (number | null)[];
            /** @description the older name of `min` */
            low?: (number | null)[];
            /** @description the older name of `max` */
            high?: (number | null)[];
        };
        FleetGateway: {
            gateway: string;
            /** @description another one at each start */
            instance: string;
            /** @description this gateway itself */
            here: boolean;
            /** @description false: it has ended, or was not heard within its lease */
            alive: boolean;
            /** @description another one that is alive has the same name */
            namesake: boolean;
            version: string;
            /** @description address of its page; empty if it has none */
            page: string;
            /** @description its clock against that of this machine, delivery included */
            clock_ahead_ms: number;
            uptime_s: number;
            /** @description since its last word came here; it speaks twice a second */
            silent_ms: number;
            axes: components["schemas"]["FleetAxis"][];
        };
        FleetAxis: {
            axis: string;
            number: number;
            family: string;
            unit: string;
            online: boolean;
            simulated: boolean;
            stale: boolean;
            referenced: boolean;
            moving: boolean;
            target_reached: boolean;
            fault: boolean;
            warning: boolean;
            /**
             * @description CiA 402 state, from the status word
             * @enum {string}
             */
            state: "not_ready_to_switch_on" | "switch_on_disabled" | "ready_to_switch_on" | "switched_on" | "operation_enabled" | "quick_stop_active" | "fault_reaction_active" | "fault";
            statusword: number;
            mode: number;
            error_code: number;
            fail_safe_cause: number;
            authority: string;
            holder: string;
            /** @description in the unit of the axis */
            position: number;
            velocity: number;
            position_increments: number;
            increments_per_unit: number;
            /**
             * Format: date-time
             * @description on its gateway's clock
             */
            at: string | null;
            /** @description since `at`, the difference of the clocks taken out, delivery included */
            age_ms: number | null;
        };
        /** @description as ProfileSpec; the unit is the path's */
        ProfileEntry: {
            unit?: number;
            language: components["schemas"]["ProfileLanguage"];
            /** @enum {string|null} */
            word_order?: "high_first" | "low_first" | null;
            axes: components["schemas"]["ProfileAxisSpec"][];
            /** @description EtherNet/IP instance of what the language's master reads */
            input_assembly?: number | null;
            /** @description EtherNet/IP instance of what it writes */
            output_assembly?: number | null;
            /** @description lexium: instance of the classes that its manual prints */
            object_instance?: number | null;
        };
        Profiles: {
            languages: components["schemas"]["LanguagePage"][];
            profiles: components["schemas"]["ProfileSpec"][];
        };
        LanguagePage: {
            language: components["schemas"]["ProfileLanguage"];
            title: string;
            description: string;
            /** @description where the device's own list of registers stands */
            source: string;
            /** @enum {string} */
            word_order: "high_first" | "low_first";
            /** @description that one unit has at most */
            axes: number;
            registers: components["schemas"]["LanguageRegister"][];
        };
        LanguageRegister: {
            tables: ("holding_registers" | "input_registers")[];
            /** @description counted from 0 */
            address: number;
            /** @enum {string} */
            type: "u16" | "i16" | "u32" | "i32" | "f32";
            /** @enum {string} */
            access: "R" | "W" | "RW";
            /** @description as the device's manual writes it */
            name: string;
            description: string;
            /** @description which axis of the profile it belongs to; null: to the unit, or to its one axis */
            axis: number | null;
            min: number | null;
            max: number | null;
            object: {
                class: number;
                attribute: number;
            } | null;
        };
        /** @enum {string} */
        ProfileLanguage: "cia402" | "lexium" | "pacontrol" | "linmot";
        ProfileAxisSpec: {
            axis: string;
            /** @description counts of the language for one unit of the axis; left out: increments (cia402, lexium), the unit itself (pacontrol), 0.1 micrometre of an axis in mm (linmot) */
            counts_per_unit?: number | null;
            /** @description unit/s: what the language starts from, and its 100 % */
            velocity?: number | null;
            /** @description unit/s^2 */
            acceleration?: number | null;
        };
        ModbusUnitSpec: {
            /** @description each at most once */
            unit: number;
            gaps: components["schemas"]["Gaps"];
        };
        /**
         * @description what a read shows at addresses where nothing is mapped. zero: 0, if the request touches something that is mapped and can be read
         *     (else exception 2); refuse: exception 2 for the whole request. A write to such an address is always exception 2.
         * @enum {string}
         */
        Gaps: "zero" | "refuse";
        ModbusUnit: {
            unit: number;
            /**
             * @description of the site; null: as the host's `[modbus] gaps` has it
             * @enum {string|null}
             */
            gaps: "zero" | "refuse" | null;
            shown: components["schemas"]["Gaps"];
            /** @description how many it has */
            mappings: number;
        };
        ModbusUnitChange: {
            /**
             * @description null: as the host's `[modbus] gaps` has it
             * @enum {string|null}
             */
            gaps: "zero" | "refuse" | null;
        };
        MappingRemoval: {
            dry_run: boolean;
            /** @description ids */
            removed: string[];
            /** @description how many are left */
            mappings: number;
        };
        /**
         * @description Puts a point of an axis at an address of a Modbus unit. Register value = point value * scale + offset, and back when it is written.
         *     Positions and velocities are in the axis' increments, as in the standard map, unless the point's name ends in `_units`.
         */
        MappingSpec: {
            /** @description given by the gateway if it is left out */
            id?: string;
            unit: number;
            /**
             * @default holding_registers
             * @enum {string}
             */
            table?: "coils" | "discrete_inputs" | "holding_registers" | "input_registers";
            /** @description counted from 0 */
            address: number;
            /** @description name of the axis; may also stand before the point, as in `feeder.position` */
            axis?: string;
            /** @description a name of /mapping-points, or a parameter's id or name, also with its element: `N[17]` */
            point: string;
            /**
             * @description left out: i32; bool for bits, string for texts
             * @enum {string}
             */
            type?: "bool" | "u16" | "i16" | "u32" | "i32" | "f32" | "u64" | "i64" | "f64" | "string";
            /**
             * @default high_first
             * @enum {string}
             */
            word_order?: "high_first" | "low_first";
            /**
             * @description not 0
             * @default 1
             */
            scale?: number;
            /** @default 0 */
            offset?: number;
            /**
             * @description left out: all that table and point allow
             * @enum {string}
             */
            access?: "R" | "W" | "RW";
            on_overflow?: components["schemas"]["Overflow"];
            /**
             * @description registers of a string
             * @default 16
             */
            length?: number;
            comment?: string;
        };
        Mapping: {
            id: string;
            unit: number;
            /** @enum {string} */
            table: "coils" | "discrete_inputs" | "holding_registers" | "input_registers";
            address: number;
            axis: string;
            point: string;
            /** @enum {string} */
            type: "bool" | "u16" | "i16" | "u32" | "i32" | "f32" | "u64" | "i64" | "f64" | "string";
            /** @enum {string} */
            word_order: "high_first" | "low_first";
            scale: number;
            offset: number;
            /** @enum {string} */
            access: "R" | "W" | "RW";
            on_overflow?: components["schemas"]["Overflow"];
            length?: number;
            comment?: string;
        };
        /**
         * @description what registers show of a value that does not fit their type, while the rest of the request goes on. mark: 0x8000... for signed numbers,
         *     0xFFFF... for unsigned ones, NaN for floating-point ones; clamp: the nearest end of the type. Left out where it is mark.
         * @default mark
         * @enum {string}
         */
        Overflow: "mark" | "clamp";
        HostPort: {
            /** @enum {string} */
            kind: "serial" | "can";
            /**
             * @description the name that the system gives it
             * @example ttyUSB0
             */
            name: string;
            /**
             * @description the line there; of a USB adapter by the name that stays, whichever socket it is plugged into. Bit rate and format are those of the family
             * @example serial:/dev/serial/by-id/usb-FTDI_FT232R-if00-port0
             */
            uri: string;
            /**
             * @description maker and product, or the driver's name; may be empty
             * @example FTDI FT232R USB UART
             */
            text: string;
            /** @description a CAN interface that is switched on; always true for a serial port */
            up: boolean;
            /** @description the line of the site that is there already */
            line: string | null;
        };
        ScanReport: {
            line: string;
            /**
             * @description none: this line was never searched
             * @enum {string}
             */
            state: "none" | "running" | "done" | "failed" | "cancelled";
            progress: number;
            asked: number;
            /** @description addresses to ask */
            of: number;
            /** @description how far the search for each family is; `asked` and `of` are their sums */
            families: {
                family: string;
                asked: number;
                of: number;
                /** @description why this family is not searched for; empty - it is */
                text: string;
            }[];
            found: {
                address: string;
                family: string;
                /** @description what it said it is */
                text: string;
                /** @description the drive of the site at that address */
                known_as: string | null;
            }[];
            /** @description why it failed or ended early */
            text: string;
        };
        RecipeParameter: {
            /** @enum {string} */
            type: "number" | "integer" | "boolean" | "text" | "axis";
            /** @description value if the run gives none; without it the argument is needed */
            default?: unknown;
            min?: number;
            max?: number;
            unit?: string;
            description?: string;
        };
        /** @description exactly one of `point` and `parameter`, and exactly one comparison */
        RecipeCondition: {
            axis: string;
            /** @description a member of the axis document: state, position, moving, referenced, fault, error_code, ... */
            point?: string;
            /** @description a parameter of the catalogue; it is read from the drive */
            parameter?: string;
            /** @description a number, a text, true or false */
            is?: unknown;
            /** @description a number, a text, true or false */
            is_not?: unknown;
            at_least?: number;
            at_most?: number;
            above?: number;
            below?: number;
            /** @description for is and is_not with numbers */
            tolerance?: number;
        };
        RecordedSteps: {
            /** @description ms since 1970 */
            from: number;
            /** @description ms since 1970 */
            to: number;
            /**
             * Format: date-time
             * @description where the recorder's stretch begins; what was before is not known
             */
            begins: string | null;
            steps: components["schemas"]["RecipeStep"][];
            /** @description what was done and is no step, and why */
            left_out: string[];
        };
        /**
         * @description One member says what is done; `comment` may stand beside it. Any value may be "${name}" of a parameter. `wait_s` of a command: the step
         *     ends when the drive is done, and fails after so many seconds; 0 or none: it ends when the drive has acknowledged. `if` holds `condition`,
         *     `then` and `else`; `repeat` holds `times`, `steps` and perhaps `until`, asked after each round. schema/recipe.schema.json has it exactly.
         */
        RecipeStep: {
            comment?: string;
            /**
             * @description axis, parameter, value
             * @example {
             *       "axis": "feeder",
             *       "parameter": "AC",
             *       "value": 20000
             *     }
             */
            set_parameter?: Record<string, never>;
            /**
             * @description axis, parameter; the value stands in the report
             * @example {
             *       "axis": "feeder",
             *       "parameter": "AC"
             *     }
             */
            read_parameter?: Record<string, never>;
            /**
             * @description axis, wait_s (10)
             * @example {
             *       "axis": "feeder"
             *     }
             */
            enable?: Record<string, never>;
            /**
             * @description axis, wait_s (10)
             * @example {
             *       "axis": "feeder"
             *     }
             */
            disable?: Record<string, never>;
            /**
             * @description axis, method, wait_s (120)
             * @example {
             *       "axis": "feeder"
             *     }
             */
            home?: Record<string, never>;
            /**
             * @description axis, wait_s, and what POST /axes/{axis}/commands takes
             * @example {
             *       "axis": "feeder",
             *       "command": "halt"
             *     }
             */
            command?: Record<string, never>;
            /**
             * @description axis, name, argument, wait_s
             * @example {
             *       "axis": "feeder",
             *       "name": "clear"
             *     }
             */
            action?: Record<string, never>;
            /**
             * @description unit, address, value, type: a set-point of the standard map or a user mapping, by the same checks as a Modbus write; a recipe with a unit that has a profile is refused when it is put, and at its run
             * @example {
             *       "unit": 1,
             *       "address": 36,
             *       "type": "u32",
             *       "value": 64000
             *     }
             */
            write_register?: Record<string, never>;
            /**
             * @description axis, input, value: an outside condition of a simulated drive (stall, load, inject_error ...), as PATCH /drives/{drive}/hand sets it; a run that reaches a real drive with it is refused
             * @example {
             *       "axis": "feeder",
             *       "input": "stall",
             *       "value": true
             *     }
             */
            simulate?: Record<string, never>;
            /** @description ends when the condition holds; the run fails if it does not within timeout_s (30) */
            wait_for?: components["schemas"]["RecipeCondition"] & {
                timeout_s?: number;
            };
            /** @description the run fails if the condition does not hold now; `text` is said then */
            check?: components["schemas"]["RecipeCondition"] & {
                text?: string;
            };
            /**
             * @description seconds
             * @example 0.5
             */
            wait_s?: unknown;
            /**
             * @description condition, then, else
             * @example {
             *       "condition": {
             *         "axis": "feeder",
             *         "point": "referenced",
             *         "is": false
             *       },
             *       "then": [
             *         {
             *           "home": {
             *             "axis": "feeder"
             *           }
             *         }
             *       ]
             *     }
             */
            if?: Record<string, never>;
            /**
             * @description times (1 to 10000), until, steps
             * @example {
             *       "times": 2,
             *       "steps": [
             *         {
             *           "wait_s": 0.1
             *         }
             *       ]
             *     }
             */
            repeat?: Record<string, never>;
            /** @description an event and a line of the report */
            message?: string;
        };
        /** @description at most 500 steps, 8 deep, 64 parameters, 256 KiB */
        RecipeDocument: {
            name?: string;
            description?: string;
            parameters?: {
                [key: string]: components["schemas"]["RecipeParameter"];
            };
            /** @description for the whole run; 3600 if it is not given */
            timeout_s?: number;
            /**
             * @description how axes are stopped that the run has set in motion
             * @enum {string}
             */
            on_failure?: "halt" | "quick_stop";
            steps: components["schemas"]["RecipeStep"][];
        };
        Recipe: components["schemas"]["RecipeDocument"] & {
            name: string;
            /** Format: date-time */
            changed_at: string;
            changed_by: string | null;
        };
        RecipeEntry: {
            name: string;
            /** @description names this state of the recipe, for If-Match */
            etag: string;
            description: string;
            parameters: {
                [key: string]: components["schemas"]["RecipeParameter"];
            };
            /** @description how many */
            steps: number;
            /** Format: date-time */
            changed_at: string;
            changed_by: string | null;
            /** @description number of the run in progress */
            running: number | null;
        };
        RecipeCheck: {
            dry_run: boolean;
            steps: number;
            /** @description with the defaults */
            arguments?: Record<string, never>;
            /** @description those that it commands */
            axes?: string[];
        };
        RecipeReportHead: {
            recipe: string;
            n: number;
            /**
             * @description interrupted: the gateway was restarted while the run was under way
             * @enum {string}
             */
            state: "running" | "stopping" | "done" | "failed" | "cancelled" | "interrupted";
            /** Format: date-time */
            started_at: string;
            /**
             * Format: date-time
             * @description of an interrupted run: the last that is known of it
             */
            ended_at: string | null;
            started_by: string;
            arguments: Record<string, never>;
            axes: string[];
            /** @description pointer of the step that is carried out, or at which the run ended early */
            at_step: string | null;
            /**
             * @description the label of that step
             * @example Step 4.3: set_parameter AC of feeder = 20000
             */
            at_label?: string | null;
            /** @description steps that were begun */
            begun: number;
            /** @description all steps */
            of: number;
            /** @description why it ended early */
            text: string;
            /** @description axes that were in motion by the run when it did not come to its end */
            stops: {
                axis: string;
                stopped: boolean;
                /** @description no stop was sent: the motion is not the run's any more; `text` says why */
                left_alone?: boolean;
                text: string;
            }[];
        };
        RecipeReport: components["schemas"]["RecipeReportHead"] & {
            /** @description all steps in the order of the document, nested ones after the one that holds them */
            steps: components["schemas"]["RecipeReportStep"][];
        };
        RecipeReportStep: {
            /** @example /steps/1/repeat/steps/0 */
            pointer: string;
            /**
             * @description the step for people, in at most 200 bytes: its number (counted from 1; steps in a `repeat` or an `if` after that of the step that holds
             *     them), the pass of the repeats around it that was begun last, and what it does
             * @example Step 4.3 (pass 2 of 5): set_parameter AC of feeder = 20000
             */
            label?: string;
            /** @example command */
            step: string;
            axis: string | null;
            /** @enum {string} */
            state: "not_run" | "running" | "done" | "failed" | "cancelled" | "interrupted";
            /** @description how often it was begun */
            times: number;
            /**
             * Format: date-time
             * @description the last time
             */
            started_at: string | null;
            /** Format: date-time */
            ended_at: string | null;
            text: string;
            /** @description what was read or looked at last; null: nothing */
            value: unknown;
            comment?: string;
        };
        MappingImport: {
            dry_run: boolean;
            /** @description rows of the table */
            rows: number;
            /** @description mappings of the site afterwards */
            mappings: number;
            differences: string[];
        };
        AssemblyImport: {
            dry_run: boolean;
            /** @description rows of the table */
            rows: number;
            /** @description the site's own afterwards */
            assemblies: number;
            differences: string[];
        };
        MappingPoint: {
            point: string;
            /** @enum {string} */
            access: "R" | "RW";
            description: string;
            /**
             * @description of registers that hold all of it
             * @enum {string}
             */
            type: "bool" | "u16" | "i16" | "u32" | "i32" | "f32";
            /**
             * @description what it is measured in, before `scale` and `offset`; `unit` - the axis' own; null - nothing
             * @enum {string|null}
             */
            unit: "increments" | "increments/s" | "increments/s^2" | "unit" | "unit/s" | "ms" | "s" | null;
            /** @description the member of an Axis that has the same value; null - none has */
            member: string | null;
        };
        SiteChange: {
            dry_run: boolean;
            valid: boolean;
            /** @description of the site in force now */
            revision: number;
            differences: string[];
            faults: components["schemas"]["Fault"][];
        };
        /** @description `subscribe`, `unsubscribe`, `set_point`, or several; unsubscribing comes first */
        StreamRequest: {
            /**
             * @example [
             *       "axes/*",
             *       "events",
             *       "lines/can0/frames"
             *     ]
             */
            subscribe?: string[];
            unsubscribe?: string[];
            /**
             * @description of the topics of this request
             * @default 100
             */
            period_ms?: number;
            set_point?: components["schemas"]["StreamedSetPoint"];
        };
        /** @description where the axis shall be, or how fast it shall go, for as long as this is sent again and again: the newest counts, nothing is answered, and `set_points` of the axis tells what came of it. Limits and authority are those of commands; the role is operator. The first one begins a stream, which ends with a stop, with a command that moves the axis, and when none has come for `good_for_ms`: then the axis' `fail_safe` says what happens (left out: a halt). After an end the client sends nothing for that time before it begins anew. At most 1000 a second */
        StreamedSetPoint: {
            axis: string;
            /** @enum {string} */
            mode: "position" | "velocity" | "torque";
            /** @description in `unit`, `unit`/s, or thousandths of the rated torque */
            value: number;
            /** @description `unit`/s, at most so fast; left out, as the next two: as the drive has it */
            velocity?: number | null;
            /** @description `unit`/s^2 */
            acceleration?: number | null;
            /** @description `unit`/s^2 */
            deceleration?: number | null;
            /** @default 500 */
            good_for_ms?: number | null;
        };
        StreamMessage: {
            topic: string;
            /**
             * Format: int64
             * @description ns since 1970
             */
            at: number;
            data: components["schemas"]["Nothing"] | components["schemas"]["Axis"] | components["schemas"]["Drive"] | components["schemas"]["Line"] | components["schemas"]["Event"] | components["schemas"]["StreamFrames"] | components["schemas"]["StreamError"] | {
                revision: number;
            };
        };
        StreamFrames: {
            /** @description frames that were overwritten before they could be sent */
            missed: number;
            frames: components["schemas"]["Frame"][];
        };
        StreamError: {
            text: string;
            /** @description the topic that is not known, where that is it */
            topic?: string;
        };
    };
    responses: {
        /** @description removed */
        Removed: {
            headers: {
                "Site-Revision": components["headers"]["SiteRevision"];
                [name: string]: unknown;
            };
            content?: never;
        };
        /** @description any other problem (405, 406, 408, 413, 421, 431, 500, 501, 503) */
        Problem: {
            headers: {
                [name: string]: unknown;
            };
            content: {
                "application/problem+json": components["schemas"]["Problem"];
            };
        };
        /** @description the request cannot be read (not JSON, an object with two members of one name, a query parameter that is none) */
        BadRequest: {
            headers: {
                [name: string]: unknown;
            };
            content: {
                /**
                 * @example {
                 *       "type": "urn:axisgate:problem:bad_request",
                 *       "title": "Bad request",
                 *       "status": 400,
                 *       "detail": "limit must be a whole number from 1 to 1000",
                 *       "code": null,
                 *       "reason": "bad_request"
                 *     }
                 */
                "application/problem+json": components["schemas"]["Problem"];
            };
        };
        /** @description the request comes from a page of another host */
        Forbidden: {
            headers: {
                [name: string]: unknown;
            };
            content: {
                /**
                 * @example {
                 *       "type": "urn:axisgate:problem:forbidden",
                 *       "title": "Forbidden",
                 *       "status": 403,
                 *       "detail": "the request comes from a page of another host (http://example.org)",
                 *       "code": null,
                 *       "reason": "forbidden"
                 *     }
                 */
                "application/problem+json": components["schemas"]["Problem"];
            };
        };
        /** @description there is none of that name */
        NotFound: {
            headers: {
                [name: string]: unknown;
            };
            content: {
                /**
                 * @example {
                 *       "type": "urn:axisgate:problem:not_found",
                 *       "title": "Not found",
                 *       "status": 404,
                 *       "detail": "there is no axis slide",
                 *       "code": null,
                 *       "reason": "not_found"
                 *     }
                 */
                "application/problem+json": components["schemas"]["Problem"];
            };
        };
        /** @description none of the accepted media types can be given */
        NotAcceptable: {
            headers: {
                [name: string]: unknown;
            };
            content: {
                /**
                 * @example {
                 *       "type": "urn:axisgate:problem:not_acceptable",
                 *       "title": "Not acceptable",
                 *       "status": 406,
                 *       "detail": "this can be given as application/json",
                 *       "code": null,
                 *       "reason": "not_acceptable"
                 *     }
                 */
                "application/problem+json": components["schemas"]["Problem"];
            };
        };
        /** @description it conflicts with what is there; `detail` names it */
        Conflict: {
            headers: {
                [name: string]: unknown;
            };
            content: {
                /**
                 * @example {
                 *       "type": "urn:axisgate:problem:conflict",
                 *       "title": "Conflict",
                 *       "status": 409,
                 *       "detail": "drive feeder is on the line can0",
                 *       "code": null,
                 *       "reason": "conflict"
                 *     }
                 */
                "application/problem+json": components["schemas"]["Problem"];
            };
        };
        /** @description the axis or the drive refused it, or it was ended before it was done */
        Refused: {
            headers: {
                [name: string]: unknown;
            };
            content: {
                /**
                 * @example {
                 *       "type": "urn:axisgate:problem:wrong_state",
                 *       "title": "Wrong state",
                 *       "status": 409,
                 *       "detail": "the axis is not enabled",
                 *       "code": null,
                 *       "reason": "wrong_state",
                 *       "axis": "feeder",
                 *       "ticket": 18,
                 *       "result": "refused",
                 *       "command": "move_absolute"
                 *     }
                 */
                "application/problem+json": components["schemas"]["CommandProblem"];
            };
        };
        /** @description the site has another revision than `If-Match` says; `changes` is the difference, `current` and `etag` are what is there now */
        PreconditionFailed: {
            headers: {
                ETag: components["headers"]["ETag"];
                [name: string]: unknown;
            };
            content: {
                "application/problem+json": components["schemas"]["Problem"];
            };
        };
        /** @description the recipe is another than `If-Match` or `If-None-Match` says; `current` and `etag` are what is there now */
        RecipePreconditionFailed: {
            headers: {
                ETag: components["headers"]["RecipeETag"];
                [name: string]: unknown;
            };
            content: {
                "application/problem+json": components["schemas"]["Problem"];
            };
        };
        /** @description its state is another than `If-Match` says; `current` and `etag` are what is there now */
        StatePreconditionFailed: {
            headers: {
                ETag: components["headers"]["StateETag"];
                [name: string]: unknown;
            };
            content: {
                "application/problem+json": components["schemas"]["Problem"];
            };
        };
        /** @description the parameter was written since: nothing was sent to the drive; `current` is the last write (parameter, value, written_at, written_by, written_through), null if nobody wrote it */
        ParameterPreconditionFailed: {
            headers: {
                ETag: components["headers"]["ParameterETag"];
                [name: string]: unknown;
            };
            content: {
                "application/problem+json": components["schemas"]["Problem"];
            };
        };
        /** @description the gateway is configured to demand `If-Match` */
        PreconditionRequired: {
            headers: {
                [name: string]: unknown;
            };
            content: {
                "application/problem+json": components["schemas"]["Problem"];
            };
        };
        /** @description the body is over 1 MiB (a backup 64 MiB; 8 KiB without credentials); it is not read */
        TooLarge: {
            headers: {
                [name: string]: unknown;
            };
            content: {
                "application/problem+json": components["schemas"]["Problem"];
            };
        };
        /** @description the body is not of a media type that is taken here, or comes with a `Content-Encoding` */
        UnsupportedMediaType: {
            headers: {
                [name: string]: unknown;
            };
            content: {
                "application/problem+json": components["schemas"]["Problem"];
            };
        };
        /** @description the document is JSON but not right; `faults` names the first 20 places, each with a remedy, `more_faults` how many there are beside */
        Unprocessable: {
            headers: {
                [name: string]: unknown;
            };
            content: {
                /**
                 * @example {
                 *       "type": "urn:axisgate:problem:out_of_range",
                 *       "title": "Out of range",
                 *       "status": 422,
                 *       "detail": "AC: 0 is outside 1..65000000 pulse/s^2",
                 *       "code": null,
                 *       "reason": "out_of_range",
                 *       "axis": "feeder",
                 *       "faults": [
                 *         {
                 *           "document": "body",
                 *           "pointer": "/value",
                 *           "text": "AC: 0 is outside 1..65000000 pulse/s^2",
                 *           "remedy": "write a value in the range"
                 *         }
                 *       ]
                 *     }
                 */
                "application/problem+json": components["schemas"]["Problem"];
            };
        };
        /** @description the line is down, or the queue is full; `Retry-After` says when to try again */
        Unavailable: {
            headers: {
                [name: string]: unknown;
            };
            content: {
                "application/problem+json": components["schemas"]["CommandProblem"];
            };
        };
        /** @description the drive did not answer */
        NoAnswer: {
            headers: {
                [name: string]: unknown;
            };
            content: {
                "application/problem+json": components["schemas"]["CommandProblem"];
            };
        };
        /** @description the database could not keep it */
        NotStored: {
            headers: {
                [name: string]: unknown;
            };
            content: {
                "application/problem+json": components["schemas"]["Problem"];
            };
        };
    };
    parameters: {
        recording: components["schemas"]["RecordingName"];
        capture: components["schemas"]["RecordingName"];
        description: components["schemas"]["DescriptionName"];
        snapshot: number;
        revision: number;
        /** @example uim342 */
        family: string;
        /** @example can0 */
        line: string;
        /** @example feeder */
        drive: string;
        /** @example feeder */
        axis: string;
        /**
         * @description id or name of the catalogue; elements of an array with their number in brackets, percent-encoded (`PP%5B5%5D`)
         * @example AC
         */
        parameter: string;
        /**
         * @description number of an alarm of the list
         * @example 12
         */
        alarm: string;
        /**
         * @description 1 to 64 letters, digits, - _ .
         * @example warm-up
         */
        recipe: string;
        /**
         * @description number of the run; counts up per recipe, also over restarts
         * @example 1
         */
        run: number;
        /** @description the change is made only if the site still has this revision (`"3"`, from `ETag` or `Site-Revision`); else 412 */
        ifMatch: string;
        /** @description seals the backup, or opens a sealed one; 12 to 256 characters, percent-encoded (each byte but letters, digits and `-._~` as `%XX`) */
        backupPassphrase: string;
        /** @description 1 replaces a stage of another client that is not applied yet */
        replaceStage: components["schemas"]["Flag"];
        /** @description the recipe is changed only if it is still the one with this `ETag`, or (`*`) if there is one; else 412 with what is there now */
        recipeIfMatch: string;
        /** @description it is done only if the state is still the one with this `ETag`; else 412 with what is there now */
        stateIfMatch: string;
        /** @description it is written only if the last write is still the one with this `ETag`; else 412 with what is there now, and nothing goes to the drive */
        parameterIfMatch: string;
        /** @description `*`: the recipe is made only if there is none of this name; else 412 with what is there now */
        recipeIfNoneMatch: string;
        /** @description 1 removes also what hangs on it (drives of a line, axes of a drive, mappings of an axis) */
        cascade: components["schemas"]["Flag"];
        /** @description seconds to wait until the command is done */
        wait: number;
    };
    requestBodies: never;
    headers: {
        /**
         * @description the revision of the site, in quotes; for `If-Match`
         * @example "3"
         */
        ETag: string;
        /**
         * @description names this state of the recipe; for `If-Match`
         * @example "9f86d081884c7d65"
         */
        RecipeETag: string;
        /**
         * @description names this state of what is answered; for `If-Match`
         * @example "9f86d081884c7d65"
         */
        StateETag: string;
        /**
         * @description names the last write of the parameter through the gateway (by whom, when, which value), not what the drive has; for `If-Match`
         * @example "never-written"
         */
        ParameterETag: string;
        /** @description the revision of the site; in quotes it is the entity tag that `If-Match` takes */
        SiteRevision: number;
        /** @description where the new entry is */
        Location: string;
    };
    pathItems: never;
}
export type $defs = Record<string, never>;
export interface operations {
    getHealth: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description alive */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    /**
                     * @example {
                     *       "status": "ok",
                     *       "uptime_s": 12.5
                     *     }
                     */
                    "application/json": components["schemas"]["Health"];
                };
            };
            default: components["responses"]["Problem"];
        };
    };
    getReady: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description ready */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    /**
                     * @example {
                     *       "ready": true,
                     *       "missing": []
                     *     }
                     */
                    "application/json": components["schemas"]["Ready"];
                };
            };
            /** @description not ready; `missing` says what is missing, one sentence each. Who is not signed in reads only how many things are missing */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    /**
                     * @example {
                     *       "type": "urn:axisgate:problem:not_ready",
                     *       "title": "Not ready",
                     *       "status": 503,
                     *       "detail": "line can0 is down",
                     *       "code": null,
                     *       "reason": "not_ready",
                     *       "ready": false,
                     *       "missing": [
                     *         "line can0 is down"
                     *       ]
                     *     }
                     */
                    "application/problem+json": components["schemas"]["NotReady"];
                };
            };
            default: components["responses"]["Problem"];
        };
    };
    getMetrics: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Prometheus text exposition format 0.0.4; every name begins with `axisgate_` */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "text/plain": string;
                };
            };
            default: components["responses"]["Problem"];
        };
    };
    getDescription: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description this file */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/yaml": string;
                };
            };
            default: components["responses"]["Problem"];
        };
    };
    getAbout: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description about this gateway */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    /**
                     * @example {
                     *       "name": "axisgate",
                     *       "version": "0.1.0",
                     *       "api": "/api/v1",
                     *       "uptime_s": 12.5,
                     *       "now": "2026-01-02T03:04:05.678901Z",
                     *       "site_revision": 3,
                     *       "families": [
                     *         "uim342"
                     *       ],
                     *       "doors": [
                     *         {
                     *           "name": "http",
                     *           "address": "127.0.0.1:8080"
                     *         },
                     *         {
                     *           "name": "modbus",
                     *           "address": "127.0.0.1:1502"
                     *         }
                     *       ],
                     *       "lines": 1,
                     *       "drives": 1,
                     *       "axes": 1
                     *     }
                     */
                    "application/json": components["schemas"]["About"];
                };
            };
            default: components["responses"]["Problem"];
        };
    };
    listFamilies: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description in order of name */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Family"][];
                };
            };
            default: components["responses"]["Problem"];
        };
    };
    getFamily: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example uim342 */
                family: components["parameters"]["family"];
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description the family */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Family"];
                };
            };
            404: components["responses"]["NotFound"];
            default: components["responses"]["Problem"];
        };
    };
    listFamilyParameters: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example uim342 */
                family: components["parameters"]["family"];
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description all of them; null where the manual is silent */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Parameter"][];
                };
            };
            404: components["responses"]["NotFound"];
            default: components["responses"]["Problem"];
        };
    };
    listFamilyCommands: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example uim342 */
                family: components["parameters"]["family"];
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description all of them */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["CatalogueCommand"][];
                };
            };
            404: components["responses"]["NotFound"];
            default: components["responses"]["Problem"];
        };
    };
    listFamilyErrors: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example uim342 */
                family: components["parameters"]["family"];
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description all of them */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["ErrorCode"][];
                };
            };
            404: components["responses"]["NotFound"];
            default: components["responses"]["Problem"];
        };
    };
    listLines: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description in the order of the site */
            200: {
                headers: {
                    "Site-Revision": components["headers"]["SiteRevision"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Line"][];
                };
            };
            default: components["responses"]["Problem"];
        };
    };
    addLine: {
        parameters: {
            query?: never;
            header?: {
                /** @description the change is made only if the site still has this revision (`"3"`, from `ETag` or `Site-Revision`); else 412 */
                "If-Match"?: components["parameters"]["ifMatch"];
            };
            path?: never;
            cookie?: never;
        };
        requestBody: {
            content: {
                /**
                 * @example {
                 *       "name": "can0",
                 *       "uri": "twin",
                 *       "family": "uim342",
                 *       "bitrate": 1000000
                 *     }
                 */
                "application/json": components["schemas"]["LineSpec"];
            };
        };
        responses: {
            /** @description added and in force */
            201: {
                headers: {
                    Location: components["headers"]["Location"];
                    "Site-Revision": components["headers"]["SiteRevision"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Line"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            409: components["responses"]["Conflict"];
            412: components["responses"]["PreconditionFailed"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    getLine: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example can0 */
                line: components["parameters"]["line"];
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description the line */
            200: {
                headers: {
                    "Site-Revision": components["headers"]["SiteRevision"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Line"];
                };
            };
            404: components["responses"]["NotFound"];
            default: components["responses"]["Problem"];
        };
    };
    replaceLine: {
        parameters: {
            query?: never;
            header?: {
                /** @description the change is made only if the site still has this revision (`"3"`, from `ETag` or `Site-Revision`); else 412 */
                "If-Match"?: components["parameters"]["ifMatch"];
            };
            path: {
                /** @example can0 */
                line: components["parameters"]["line"];
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["LineChange"];
            };
        };
        responses: {
            /** @description replaced and in force */
            200: {
                headers: {
                    "Site-Revision": components["headers"]["SiteRevision"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Line"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Conflict"];
            412: components["responses"]["PreconditionFailed"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    removeLine: {
        parameters: {
            query?: {
                /** @description 1 removes also what hangs on it (drives of a line, axes of a drive, mappings of an axis) */
                cascade?: components["parameters"]["cascade"];
            };
            header?: {
                /** @description the change is made only if the site still has this revision (`"3"`, from `ETag` or `Site-Revision`); else 412 */
                "If-Match"?: components["parameters"]["ifMatch"];
            };
            path: {
                /** @example can0 */
                line: components["parameters"]["line"];
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            204: components["responses"]["Removed"];
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Conflict"];
            412: components["responses"]["PreconditionFailed"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    changeLine: {
        parameters: {
            query?: never;
            header?: {
                /** @description the change is made only if the site still has this revision (`"3"`, from `ETag` or `Site-Revision`); else 412 */
                "If-Match"?: components["parameters"]["ifMatch"];
            };
            path: {
                /** @example can0 */
                line: components["parameters"]["line"];
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                /**
                 * @example {
                 *       "bitrate": 500000
                 *     }
                 */
                "application/json": components["schemas"]["LinePatch"];
                "application/merge-patch+json": components["schemas"]["LinePatch"];
            };
        };
        responses: {
            /** @description changed and in force */
            200: {
                headers: {
                    "Site-Revision": components["headers"]["SiteRevision"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Line"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Conflict"];
            412: components["responses"]["PreconditionFailed"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    getTrace: {
        parameters: {
            query?: {
                /** @description json; candump (the log format of can-utils; of a byte line the same as text); pcapng (for Wireshark); text (a line per frame) */
                format?: "json" | "candump" | "pcapng" | "text";
                /** @description frames with this sequence number or a greater one, the oldest `limit` of them; left out - the newest `limit` */
                since?: number;
                /** @description at most so many frames; without it 1000 as JSON, and all that is kept (at most 65536) in a file */
                limit?: number;
            };
            header?: never;
            path: {
                /** @example can0 */
                line: components["parameters"]["line"];
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description the frames */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Trace"];
                    /** @example (1700000000.123456) can0 04280095#01 */
                    "text/plain": string;
                    "application/x-pcapng": string;
                };
            };
            400: components["responses"]["BadRequest"];
            404: components["responses"]["NotFound"];
            406: components["responses"]["NotAcceptable"];
            default: components["responses"]["Problem"];
        };
    };
    listHostPorts: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description CAN interfaces first, each kind by name; 256 at most */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["HostPort"][];
                };
            };
            default: components["responses"]["Problem"];
        };
    };
    getScan: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example can0 */
                line: components["parameters"]["line"];
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description the report */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["ScanReport"];
                };
            };
            404: components["responses"]["NotFound"];
            default: components["responses"]["Problem"];
        };
    };
    startScan: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example can0 */
                line: components["parameters"]["line"];
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                /**
                 * @example {
                 *       "from": 5,
                 *       "to": 20
                 *     }
                 */
                "application/json": {
                    /**
                     * @description first address, in the form of the family; all if it is not given
                     * @example 5
                     */
                    from?: string | number;
                    /**
                     * @description last address
                     * @example 20
                     */
                    to?: string | number;
                    /**
                     * @description to be searched for; all of the line if it is not given. On a CAN line also one that is not on it yet
                     * @example uim342
                     */
                    family?: string;
                    /** @default 120 */
                    limit_s?: number;
                };
            };
        };
        responses: {
            /** @description it has begun */
            202: {
                headers: {
                    Location?: string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["ScanReport"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Conflict"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            default: components["responses"]["Problem"];
        };
    };
    cancelScan: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example can0 */
                line: components["parameters"]["line"];
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description the report */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["ScanReport"];
                };
            };
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            default: components["responses"]["Problem"];
        };
    };
    listDrives: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description in the order of the site */
            200: {
                headers: {
                    "Site-Revision": components["headers"]["SiteRevision"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Drive"][];
                };
            };
            default: components["responses"]["Problem"];
        };
    };
    addDrive: {
        parameters: {
            query?: never;
            header?: {
                /** @description the change is made only if the site still has this revision (`"3"`, from `ETag` or `Site-Revision`); else 412 */
                "If-Match"?: components["parameters"]["ifMatch"];
            };
            path?: never;
            cookie?: never;
        };
        requestBody: {
            content: {
                /**
                 * @example {
                 *       "name": "feeder",
                 *       "line": "can0",
                 *       "address": 5,
                 *       "presence": "auto"
                 *     }
                 */
                "application/json": components["schemas"]["DriveSpec"];
            };
        };
        responses: {
            /** @description added and in force */
            201: {
                headers: {
                    Location: components["headers"]["Location"];
                    "Site-Revision": components["headers"]["SiteRevision"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Drive"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            409: components["responses"]["Conflict"];
            412: components["responses"]["PreconditionFailed"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    getDrive: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example feeder */
                drive: components["parameters"]["drive"];
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description the drive */
            200: {
                headers: {
                    "Site-Revision": components["headers"]["SiteRevision"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Drive"];
                };
            };
            404: components["responses"]["NotFound"];
            default: components["responses"]["Problem"];
        };
    };
    replaceDrive: {
        parameters: {
            query?: never;
            header?: {
                /** @description the change is made only if the site still has this revision (`"3"`, from `ETag` or `Site-Revision`); else 412 */
                "If-Match"?: components["parameters"]["ifMatch"];
            };
            path: {
                /** @example feeder */
                drive: components["parameters"]["drive"];
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["DriveChange"];
            };
        };
        responses: {
            /** @description replaced and in force */
            200: {
                headers: {
                    "Site-Revision": components["headers"]["SiteRevision"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Drive"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Conflict"];
            412: components["responses"]["PreconditionFailed"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    removeDrive: {
        parameters: {
            query?: {
                /** @description 1 removes also what hangs on it (drives of a line, axes of a drive, mappings of an axis) */
                cascade?: components["parameters"]["cascade"];
            };
            header?: {
                /** @description the change is made only if the site still has this revision (`"3"`, from `ETag` or `Site-Revision`); else 412 */
                "If-Match"?: components["parameters"]["ifMatch"];
            };
            path: {
                /** @example feeder */
                drive: components["parameters"]["drive"];
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            204: components["responses"]["Removed"];
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Conflict"];
            412: components["responses"]["PreconditionFailed"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    changeDrive: {
        parameters: {
            query?: never;
            header?: {
                /** @description the change is made only if the site still has this revision (`"3"`, from `ETag` or `Site-Revision`); else 412 */
                "If-Match"?: components["parameters"]["ifMatch"];
            };
            path: {
                /** @example feeder */
                drive: components["parameters"]["drive"];
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                /**
                 * @example {
                 *       "presence": "twin"
                 *     }
                 */
                "application/json": components["schemas"]["DrivePatch"];
                "application/merge-patch+json": components["schemas"]["DrivePatch"];
            };
        };
        responses: {
            /** @description changed and in force */
            200: {
                headers: {
                    "Site-Revision": components["headers"]["SiteRevision"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Drive"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Conflict"];
            412: components["responses"]["PreconditionFailed"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    exchangeNative: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example feeder */
                drive: components["parameters"]["drive"];
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["NativeRequest"];
            };
        };
        responses: {
            /** @description what the drive answered */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    /**
                     * @example {
                     *       "reply": "51200",
                     *       "reply_hex": "35313230300D",
                     *       "took_ms": 7.125
                     *     }
                     */
                    "application/json": components["schemas"]["NativeReply"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Conflict"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            503: components["responses"]["Unavailable"];
            504: components["responses"]["NoAnswer"];
            default: components["responses"]["Problem"];
        };
    };
    getHand: {
        parameters: {
            query?: {
                /** @description 1 answers a list with a description of each item in place of the plain object */
                describe?: components["schemas"]["Flag"];
            };
            header?: never;
            path: {
                /** @example feeder */
                drive: components["parameters"]["drive"];
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description names and values, or the described list */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    /**
                     * @example {
                     *       "power": true,
                     *       "silent": false,
                     *       "stall": false,
                     *       "inputs": 0,
                     *       "temperature": 25
                     *     }
                     */
                    "application/json": components["schemas"]["Hand"] | components["schemas"]["HandItem"][];
                };
            };
            404: components["responses"]["NotFound"];
            409: components["responses"]["Conflict"];
            default: components["responses"]["Problem"];
        };
    };
    setHand: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example feeder */
                drive: components["parameters"]["drive"];
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["Hand"];
            };
        };
        responses: {
            /** @description set; the conditions as they are now */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Hand"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Conflict"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            default: components["responses"]["Problem"];
        };
    };
    changeHand: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example feeder */
                drive: components["parameters"]["drive"];
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                /**
                 * @example {
                 *       "stall": true
                 *     }
                 */
                "application/json": components["schemas"]["Hand"];
                "application/merge-patch+json": components["schemas"]["Hand"];
            };
        };
        responses: {
            /** @description set; the conditions as they are now */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Hand"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Conflict"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            default: components["responses"]["Problem"];
        };
    };
    listAxes: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description in the order of the site */
            200: {
                headers: {
                    "Site-Revision": components["headers"]["SiteRevision"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Axis"][];
                };
            };
            default: components["responses"]["Problem"];
        };
    };
    addAxis: {
        parameters: {
            query?: never;
            header?: {
                /** @description the change is made only if the site still has this revision (`"3"`, from `ETag` or `Site-Revision`); else 412 */
                "If-Match"?: components["parameters"]["ifMatch"];
            };
            path?: never;
            cookie?: never;
        };
        requestBody: {
            content: {
                /**
                 * @example {
                 *       "name": "feeder",
                 *       "drive": "feeder",
                 *       "channel": 1,
                 *       "number": 1,
                 *       "unit": "mm",
                 *       "increments_per_unit": 3200
                 *     }
                 */
                "application/json": components["schemas"]["AxisSpec"];
            };
        };
        responses: {
            /** @description added and in force */
            201: {
                headers: {
                    Location: components["headers"]["Location"];
                    "Site-Revision": components["headers"]["SiteRevision"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Axis"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            409: components["responses"]["Conflict"];
            412: components["responses"]["PreconditionFailed"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    getAxis: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example feeder */
                axis: components["parameters"]["axis"];
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description the axis */
            200: {
                headers: {
                    "Site-Revision": components["headers"]["SiteRevision"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Axis"];
                };
            };
            404: components["responses"]["NotFound"];
            default: components["responses"]["Problem"];
        };
    };
    replaceAxis: {
        parameters: {
            query?: never;
            header?: {
                /** @description the change is made only if the site still has this revision (`"3"`, from `ETag` or `Site-Revision`); else 412 */
                "If-Match"?: components["parameters"]["ifMatch"];
            };
            path: {
                /** @example feeder */
                axis: components["parameters"]["axis"];
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["AxisChange"];
            };
        };
        responses: {
            /** @description replaced and in force */
            200: {
                headers: {
                    "Site-Revision": components["headers"]["SiteRevision"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Axis"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Conflict"];
            412: components["responses"]["PreconditionFailed"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    removeAxis: {
        parameters: {
            query?: {
                /** @description 1 removes also what hangs on it (drives of a line, axes of a drive, mappings of an axis) */
                cascade?: components["parameters"]["cascade"];
            };
            header?: {
                /** @description the change is made only if the site still has this revision (`"3"`, from `ETag` or `Site-Revision`); else 412 */
                "If-Match"?: components["parameters"]["ifMatch"];
            };
            path: {
                /** @example feeder */
                axis: components["parameters"]["axis"];
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            204: components["responses"]["Removed"];
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Conflict"];
            412: components["responses"]["PreconditionFailed"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    changeAxis: {
        parameters: {
            query?: never;
            header?: {
                /** @description the change is made only if the site still has this revision (`"3"`, from `ETag` or `Site-Revision`); else 412 */
                "If-Match"?: components["parameters"]["ifMatch"];
            };
            path: {
                /** @example feeder */
                axis: components["parameters"]["axis"];
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                /**
                 * @example {
                 *       "unit": "deg",
                 *       "increments_per_unit": 8.88888888888889
                 *     }
                 */
                "application/json": components["schemas"]["AxisPatch"];
                "application/merge-patch+json": components["schemas"]["AxisPatch"];
            };
        };
        responses: {
            /** @description changed and in force */
            200: {
                headers: {
                    "Site-Revision": components["headers"]["SiteRevision"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Axis"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Conflict"];
            412: components["responses"]["PreconditionFailed"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    commandAxis: {
        parameters: {
            query?: {
                /** @description seconds to wait until the command is done */
                wait?: components["parameters"]["wait"];
            };
            header?: never;
            path: {
                /** @example feeder */
                axis: components["parameters"]["axis"];
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["Command"];
            };
        };
        responses: {
            /** @description acknowledged, or done */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    /**
                     * @example {
                     *       "ticket": 17,
                     *       "result": "accepted",
                     *       "reason": "",
                     *       "axis": "feeder",
                     *       "command": "move_absolute",
                     *       "code": null,
                     *       "text": "",
                     *       "value": null
                     *     }
                     */
                    "application/json": components["schemas"]["CommandAnswer"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Refused"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            503: components["responses"]["Unavailable"];
            504: components["responses"]["NoAnswer"];
            default: components["responses"]["Problem"];
        };
    };
    actOnAxis: {
        parameters: {
            query?: {
                /** @description seconds to wait until the command is done */
                wait?: components["parameters"]["wait"];
            };
            header?: never;
            path: {
                /** @example feeder */
                axis: components["parameters"]["axis"];
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                /**
                 * @example {
                 *       "name": "program.start",
                 *       "argument": "1"
                 *     }
                 */
                "application/json": components["schemas"]["Action"];
            };
        };
        responses: {
            /** @description acknowledged, or done; `text` is what the drive answered */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["CommandAnswer"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Refused"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            503: components["responses"]["Unavailable"];
            504: components["responses"]["NoAnswer"];
            default: components["responses"]["Problem"];
        };
    };
    listAuthority: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description all axes */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["AuthorityList"];
                };
            };
            default: components["responses"]["Problem"];
        };
    };
    getAuthority: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example feeder */
                axis: components["parameters"]["axis"];
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description who holds it */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Authority"];
                };
            };
            404: components["responses"]["NotFound"];
            default: components["responses"]["Problem"];
        };
    };
    takeAuthority: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example feeder */
                axis: components["parameters"]["axis"];
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                /**
                 * @example {
                 *       "ttl_s": 30
                 *     }
                 */
                "application/json": components["schemas"]["TakeAuthority"];
            };
        };
        responses: {
            /** @description held */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Authority"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Refused"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            503: components["responses"]["Unavailable"];
            504: components["responses"]["NoAnswer"];
            default: components["responses"]["Problem"];
        };
    };
    releaseAuthority: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example feeder */
                axis: components["parameters"]["axis"];
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description nobody holds it now */
            204: {
                headers: {
                    [name: string]: unknown;
                };
                content?: never;
            };
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Refused"];
            503: components["responses"]["Unavailable"];
            504: components["responses"]["NoAnswer"];
            default: components["responses"]["Problem"];
        };
    };
    handOverAuthority: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example feeder */
                axis: components["parameters"]["axis"];
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                /**
                 * @example {
                 *       "to": "modbus 192.0.2.7"
                 *     }
                 */
                "application/json": components["schemas"]["HandOver"];
            };
        };
        responses: {
            /** @description held by the other */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Authority"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Refused"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            503: components["responses"]["Unavailable"];
            504: components["responses"]["NoAnswer"];
            default: components["responses"]["Problem"];
        };
    };
    getModbus: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description the door */
            200: {
                headers: {
                    ETag: components["headers"]["StateETag"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["ModbusDoor"];
                };
            };
            503: components["responses"]["Unavailable"];
            504: components["responses"]["NoAnswer"];
            default: components["responses"]["Problem"];
        };
    };
    changeModbus: {
        parameters: {
            query?: never;
            header?: {
                /** @description it is done only if the state is still the one with this `ETag`; else 412 with what is there now */
                "If-Match"?: components["parameters"]["stateIfMatch"];
            };
            path?: never;
            cookie?: never;
        };
        requestBody: {
            content: {
                /**
                 * @example {
                 *       "read_only": true
                 *     }
                 */
                "application/json": components["schemas"]["ModbusChange"];
            };
        };
        responses: {
            /** @description the door */
            200: {
                headers: {
                    ETag: components["headers"]["StateETag"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["ModbusDoor"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            412: components["responses"]["StatePreconditionFailed"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            503: components["responses"]["Unavailable"];
            504: components["responses"]["NoAnswer"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    listConnections: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description the connections, by id */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["ClientConnection"][];
                };
            };
            503: components["responses"]["Unavailable"];
            504: components["responses"]["NoAnswer"];
            default: components["responses"]["Problem"];
        };
    };
    closeConnection: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @description its id in the list */
                connection: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description it is closed */
            204: {
                headers: {
                    [name: string]: unknown;
                };
                content?: never;
            };
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            503: components["responses"]["Unavailable"];
            504: components["responses"]["NoAnswer"];
            default: components["responses"]["Problem"];
        };
    };
    getEds: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description the sheet, as a file; its revision and that of the identity object come from the mapping */
            200: {
                headers: {
                    /** @description registers 18 and 19, eight hex digits */
                    "Mapping-Revision"?: string;
                    [name: string]: unknown;
                };
                content: {
                    "text/plain": string;
                };
            };
            404: components["responses"]["NotFound"];
            default: components["responses"]["Problem"];
        };
    };
    listDescriptions: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description in order of name */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["DescriptionEntry"][];
                };
            };
            default: components["responses"]["Problem"];
        };
    };
    addDescription: {
        parameters: {
            query?: {
                /** @description of the description, with its ending; not needed with JSON */
                name?: components["schemas"]["DescriptionName"];
            };
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody: {
            content: {
                "text/plain": string;
                "application/octet-stream": string;
                "application/json": {
                    name?: components["schemas"]["DescriptionName"];
                    /** @description the file */
                    text: string;
                };
            };
        };
        responses: {
            /** @description the same text is there under this name already */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Description"];
                };
            };
            /** @description kept */
            201: {
                headers: {
                    /** @description where it is */
                    Location?: string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Description"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            409: components["responses"]["Conflict"];
            413: components["responses"]["TooLarge"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    getDriveDescription: {
        parameters: {
            query?: {
                /** @description eds - the file as it came; left out - by Accept */
                format?: "json" | "eds";
            };
            header?: never;
            path: {
                description: components["parameters"]["description"];
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description facts, or the file byte by byte */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Description"];
                    "text/plain": string;
                };
            };
            400: components["responses"]["BadRequest"];
            404: components["responses"]["NotFound"];
            406: components["responses"]["NotAcceptable"];
            default: components["responses"]["Problem"];
        };
    };
    removeDescription: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                description: components["parameters"]["description"];
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description removed */
            204: {
                headers: {
                    [name: string]: unknown;
                };
                content?: never;
            };
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Conflict"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    getFailSafe: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description the causes with their defaults, and what the site names for each axis */
            200: {
                headers: {
                    "Site-Revision": components["headers"]["SiteRevision"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["FailSafeMatrix"];
                };
            };
            default: components["responses"]["Problem"];
        };
    };
    getAxisFailSafe: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example feeder */
                axis: components["parameters"]["axis"];
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description its row */
            200: {
                headers: {
                    "Site-Revision": components["headers"]["SiteRevision"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["FailSafeRow"];
                };
            };
            404: components["responses"]["NotFound"];
            default: components["responses"]["Problem"];
        };
    };
    putAxisFailSafe: {
        parameters: {
            query?: never;
            header?: {
                /** @description the change is made only if the site still has this revision (`"3"`, from `ETag` or `Site-Revision`); else 412 */
                "If-Match"?: components["parameters"]["ifMatch"];
            };
            path: {
                /** @example feeder */
                axis: components["parameters"]["axis"];
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                /**
                 * @example {
                 *       "modbus_closed": "quick_stop",
                 *       "line_lost": "disable",
                 *       "watchdog_ms": 1000
                 *     }
                 */
                "application/json": components["schemas"]["FailSafeChoice"];
            };
        };
        responses: {
            /** @description its row */
            200: {
                headers: {
                    "Site-Revision": components["headers"]["SiteRevision"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["FailSafeRow"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Conflict"];
            412: components["responses"]["PreconditionFailed"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            503: components["responses"]["Unavailable"];
            504: components["responses"]["NoAnswer"];
            default: components["responses"]["Problem"];
        };
    };
    getFailSafeRehearsal: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description state and report */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["FailSafeRehearsal"];
                };
            };
            default: components["responses"]["Problem"];
        };
    };
    rehearseFailSafe: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody: {
            content: {
                /** @example {} */
                "application/json": {
                    /** @description names; left out: all */
                    axes?: string[];
                    /** @description what happens beside the loss; left out: all; empty: nothing */
                    steps?: components["schemas"]["RehearsalStep"][];
                };
            };
        };
        responses: {
            /** @description it has begun; GET tells the rest */
            202: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["FailSafeRehearsal"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            409: components["responses"]["Conflict"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            default: components["responses"]["Problem"];
        };
    };
    listParameters: {
        parameters: {
            query?: {
                /** @description this group alone */
                group?: string;
                /** @description the elements of this array alone */
                array?: string;
                /** @description with `array`, begin with this element; at most 1024 elements are answered */
                first?: number;
            };
            header?: never;
            path: {
                /** @example feeder */
                axis: components["parameters"]["axis"];
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description in the order of the catalogue */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["AxisParameter"][];
                };
            };
            400: components["responses"]["BadRequest"];
            404: components["responses"]["NotFound"];
            default: components["responses"]["Problem"];
        };
    };
    readParameter: {
        parameters: {
            query?: {
                /** @description 1 answers the last known value, without an exchange with the drive */
                cached?: components["schemas"]["Flag"];
                /** @description so many of the last writes through the gateway, newest first, in `history` */
                history?: number;
            };
            header?: never;
            path: {
                /** @example feeder */
                axis: components["parameters"]["axis"];
                /**
                 * @description id or name of the catalogue; elements of an array with their number in brackets, percent-encoded (`PP%5B5%5D`)
                 * @example AC
                 */
                parameter: components["parameters"]["parameter"];
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description the parameter */
            200: {
                headers: {
                    ETag: components["headers"]["ParameterETag"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["AxisParameter"];
                };
            };
            400: components["responses"]["BadRequest"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Refused"];
            503: components["responses"]["Unavailable"];
            504: components["responses"]["NoAnswer"];
            default: components["responses"]["Problem"];
        };
    };
    writeParameter: {
        parameters: {
            query?: never;
            header?: {
                /** @description it is written only if the last write is still the one with this `ETag`; else 412 with what is there now, and nothing goes to the drive */
                "If-Match"?: components["parameters"]["parameterIfMatch"];
            };
            path: {
                /** @example feeder */
                axis: components["parameters"]["axis"];
                /**
                 * @description id or name of the catalogue; elements of an array with their number in brackets, percent-encoded (`PP%5B5%5D`)
                 * @example AC
                 */
                parameter: components["parameters"]["parameter"];
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                /**
                 * @example {
                 *       "value": 20000
                 *     }
                 */
                "application/json": components["schemas"]["ParameterWrite"];
            };
        };
        responses: {
            /** @description the drive took it, and it is stored; `value` is what the drive took */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["CommandAnswer"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Refused"];
            412: components["responses"]["ParameterPreconditionFailed"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            503: components["responses"]["Unavailable"];
            504: components["responses"]["NoAnswer"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    startMoves: {
        parameters: {
            query?: {
                /** @description seconds to wait until the command is done */
                wait?: components["parameters"]["wait"];
            };
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody: {
            content: {
                /**
                 * @example {
                 *       "axes": [
                 *         "left",
                 *         "right"
                 *       ]
                 *     }
                 */
                "application/json": components["schemas"]["MovesStart"];
            };
        };
        responses: {
            /** @description started, or all done */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["CommandAnswer"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            409: components["responses"]["Refused"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            503: components["responses"]["Unavailable"];
            504: components["responses"]["NoAnswer"];
            default: components["responses"]["Problem"];
        };
    };
    getSite: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description the site in force */
            200: {
                headers: {
                    ETag: components["headers"]["ETag"];
                    "Site-Revision": components["headers"]["SiteRevision"];
                    [name: string]: unknown;
                };
                content: {
                    /**
                     * @example {
                     *       "lines": [
                     *         {
                     *           "name": "can0",
                     *           "uri": "twin",
                     *           "family": "uim342",
                     *           "bitrate": 1000000
                     *         }
                     *       ],
                     *       "drives": [
                     *         {
                     *           "name": "feeder",
                     *           "line": "can0",
                     *           "address": 5,
                     *           "presence": "auto"
                     *         }
                     *       ],
                     *       "axes": [
                     *         {
                     *           "name": "feeder",
                     *           "drive": "feeder",
                     *           "channel": 1,
                     *           "number": 1,
                     *           "unit": "mm",
                     *           "increments_per_unit": 3200
                     *         }
                     *       ],
                     *       "mappings": []
                     *     }
                     */
                    "application/json": components["schemas"]["Site"];
                };
            };
            /** @description the site is the one of `If-None-Match` */
            304: {
                headers: {
                    [name: string]: unknown;
                };
                content?: never;
            };
            default: components["responses"]["Problem"];
        };
    };
    replaceSite: {
        parameters: {
            query?: {
                /** @description 1 answers what would change and what is wrong, and changes nothing */
                dry_run?: components["schemas"]["Flag"];
            };
            header?: {
                /** @description the change is made only if the site still has this revision (`"3"`, from `ETag` or `Site-Revision`); else 412 */
                "If-Match"?: components["parameters"]["ifMatch"];
            };
            path?: never;
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["Site"];
            };
        };
        responses: {
            /** @description stored and in force; with `dry_run` what would be */
            200: {
                headers: {
                    ETag: components["headers"]["ETag"];
                    "Site-Revision": components["headers"]["SiteRevision"];
                    [name: string]: unknown;
                };
                content: {
                    /**
                     * @example {
                     *       "dry_run": true,
                     *       "valid": true,
                     *       "revision": 3,
                     *       "differences": [
                     *         "axis feeder: unit mm -> deg"
                     *       ],
                     *       "faults": []
                     *     }
                     */
                    "application/json": components["schemas"]["SiteChange"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            409: components["responses"]["Conflict"];
            412: components["responses"]["PreconditionFailed"];
            413: components["responses"]["TooLarge"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            428: components["responses"]["PreconditionRequired"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    listMappings: {
        parameters: {
            query?: {
                /** @description of this Modbus unit alone */
                unit?: number;
                /** @description of this axis alone */
                axis?: string;
            };
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description the mappings, in the order of the site */
            200: {
                headers: {
                    "Site-Revision": components["headers"]["SiteRevision"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Mapping"][];
                };
            };
            400: components["responses"]["BadRequest"];
            default: components["responses"]["Problem"];
        };
    };
    addMapping: {
        parameters: {
            query?: never;
            header?: {
                /** @description the change is made only if the site still has this revision (`"3"`, from `ETag` or `Site-Revision`); else 412 */
                "If-Match"?: components["parameters"]["ifMatch"];
            };
            path?: never;
            cookie?: never;
        };
        requestBody: {
            content: {
                /**
                 * @example {
                 *       "unit": 2,
                 *       "table": "holding_registers",
                 *       "address": 0,
                 *       "axis": "feeder",
                 *       "point": "position_units",
                 *       "type": "f32"
                 *     }
                 */
                "application/json": components["schemas"]["MappingSpec"];
            };
        };
        responses: {
            /** @description added and in force */
            201: {
                headers: {
                    Location?: string;
                    "Site-Revision": components["headers"]["SiteRevision"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Mapping"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            409: components["responses"]["Conflict"];
            412: components["responses"]["PreconditionFailed"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    removeMappings: {
        parameters: {
            query?: {
                /** @description of this Modbus unit alone */
                unit?: number;
                /** @description of this axis alone */
                axis?: string;
                /** @description ids with commas between them */
                ids?: string;
                /** @description 1 removes all; then without another condition */
                all?: components["schemas"]["Flag"];
                /** @description 1 answers what would be removed, and changes nothing */
                dry_run?: components["schemas"]["Flag"];
            };
            header?: {
                /** @description the change is made only if the site still has this revision (`"3"`, from `ETag` or `Site-Revision`); else 412 */
                "If-Match"?: components["parameters"]["ifMatch"];
            };
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description removed; with `dry_run` what would be */
            200: {
                headers: {
                    "Site-Revision": components["headers"]["SiteRevision"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["MappingRemoval"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Conflict"];
            412: components["responses"]["PreconditionFailed"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    exportMappings: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description one line per mapping below a line of column names */
            200: {
                headers: {
                    "Site-Revision": components["headers"]["SiteRevision"];
                    [name: string]: unknown;
                };
                content: {
                    "text/csv": string;
                };
            };
            default: components["responses"]["Problem"];
        };
    };
    replaceMappings: {
        parameters: {
            query?: {
                /** @description 1 answers what would change, and changes nothing */
                dry_run?: components["schemas"]["Flag"];
            };
            header?: {
                /** @description the change is made only if the site still has this revision (`"3"`, from `ETag` or `Site-Revision`); else 412 */
                "If-Match"?: components["parameters"]["ifMatch"];
            };
            path?: never;
            cookie?: never;
        };
        requestBody: {
            content: {
                /**
                 * @example unit,address,axis,point,type
                 *     2,0,feeder,position,i32
                 */
                "text/csv": string;
            };
        };
        responses: {
            /** @description taken; with `dry_run` what would be */
            200: {
                headers: {
                    "Site-Revision": components["headers"]["SiteRevision"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["MappingImport"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            412: components["responses"]["PreconditionFailed"];
            413: components["responses"]["TooLarge"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    addMappings: {
        parameters: {
            query?: {
                /** @description 1 answers what would change, and changes nothing */
                dry_run?: components["schemas"]["Flag"];
            };
            header?: {
                /** @description the change is made only if the site still has this revision (`"3"`, from `ETag` or `Site-Revision`); else 412 */
                "If-Match"?: components["parameters"]["ifMatch"];
            };
            path?: never;
            cookie?: never;
        };
        requestBody: {
            content: {
                /**
                 * @example unit,address,axis,point,type
                 *     2,0,feeder,position,i32
                 */
                "text/csv": string;
            };
        };
        responses: {
            /** @description taken; with `dry_run` what would be */
            200: {
                headers: {
                    "Site-Revision": components["headers"]["SiteRevision"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["MappingImport"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            412: components["responses"]["PreconditionFailed"];
            413: components["responses"]["TooLarge"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    getMapping: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @description id of the mapping */
                mapping: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description the mapping */
            200: {
                headers: {
                    "Site-Revision": components["headers"]["SiteRevision"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Mapping"];
                };
            };
            404: components["responses"]["NotFound"];
            default: components["responses"]["Problem"];
        };
    };
    replaceMapping: {
        parameters: {
            query?: never;
            header?: {
                /** @description the change is made only if the site still has this revision (`"3"`, from `ETag` or `Site-Revision`); else 412 */
                "If-Match"?: components["parameters"]["ifMatch"];
            };
            path: {
                /** @description id of the mapping */
                mapping: string;
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                /**
                 * @example {
                 *       "unit": 2,
                 *       "table": "holding_registers",
                 *       "address": 0,
                 *       "axis": "feeder",
                 *       "point": "position_units",
                 *       "type": "f32"
                 *     }
                 */
                "application/json": components["schemas"]["MappingSpec"];
            };
        };
        responses: {
            /** @description replaced and in force */
            200: {
                headers: {
                    "Site-Revision": components["headers"]["SiteRevision"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Mapping"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Conflict"];
            412: components["responses"]["PreconditionFailed"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    removeMapping: {
        parameters: {
            query?: never;
            header?: {
                /** @description the change is made only if the site still has this revision (`"3"`, from `ETag` or `Site-Revision`); else 412 */
                "If-Match"?: components["parameters"]["ifMatch"];
            };
            path: {
                /** @description id of the mapping */
                mapping: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            204: components["responses"]["Removed"];
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            412: components["responses"]["PreconditionFailed"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    listMappingPoints: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description the points */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["MappingPoint"][];
                };
            };
            default: components["responses"]["Problem"];
        };
    };
    listRecipes: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description the recipes, without their steps */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["RecipeEntry"][];
                };
            };
            default: components["responses"]["Problem"];
        };
    };
    getRecipe: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /**
                 * @description 1 to 64 letters, digits, - _ .
                 * @example warm-up
                 */
                recipe: components["parameters"]["recipe"];
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description the recipe */
            200: {
                headers: {
                    ETag: components["headers"]["RecipeETag"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Recipe"];
                };
            };
            404: components["responses"]["NotFound"];
            default: components["responses"]["Problem"];
        };
    };
    putRecipe: {
        parameters: {
            query?: {
                /** @description 1 checks the document and keeps nothing */
                dry_run?: components["schemas"]["Flag"];
            };
            header?: {
                /** @description the recipe is changed only if it is still the one with this `ETag`, or (`*`) if there is one; else 412 with what is there now */
                "If-Match"?: components["parameters"]["recipeIfMatch"];
                /** @description `*`: the recipe is made only if there is none of this name; else 412 with what is there now */
                "If-None-Match"?: components["parameters"]["recipeIfNoneMatch"];
            };
            path: {
                /**
                 * @description 1 to 64 letters, digits, - _ .
                 * @example warm-up
                 */
                recipe: components["parameters"]["recipe"];
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                /**
                 * @example {
                 *       "description": "to the middle and back",
                 *       "parameters": {
                 *         "distance": {
                 *           "type": "number",
                 *           "default": 10,
                 *           "min": 0,
                 *           "max": 100,
                 *           "unit": "mm"
                 *         }
                 *       },
                 *       "on_failure": "halt",
                 *       "steps": [
                 *         {
                 *           "enable": {
                 *             "axis": "feeder"
                 *           }
                 *         },
                 *         {
                 *           "repeat": {
                 *             "times": 3,
                 *             "steps": [
                 *               {
                 *                 "command": {
                 *                   "axis": "feeder",
                 *                   "command": "move_relative",
                 *                   "position": "${distance}",
                 *                   "velocity": 20,
                 *                   "wait_s": 30
                 *                 }
                 *               },
                 *               {
                 *                 "wait_s": 0.5
                 *               }
                 *             ]
                 *           }
                 *         },
                 *         {
                 *           "wait_for": {
                 *             "axis": "feeder",
                 *             "point": "moving",
                 *             "is": false,
                 *             "timeout_s": 5
                 *           }
                 *         },
                 *         {
                 *           "check": {
                 *             "axis": "feeder",
                 *             "point": "fault",
                 *             "is": false
                 *           }
                 *         },
                 *         {
                 *           "disable": {
                 *             "axis": "feeder"
                 *           }
                 *         }
                 *       ]
                 *     }
                 */
                "application/json": components["schemas"]["RecipeDocument"];
            };
        };
        responses: {
            /** @description replaced; with `dry_run` what was found */
            200: {
                headers: {
                    ETag: components["headers"]["RecipeETag"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Recipe"] | components["schemas"]["RecipeCheck"];
                };
            };
            /** @description made */
            201: {
                headers: {
                    Location?: string;
                    ETag: components["headers"]["RecipeETag"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Recipe"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            409: components["responses"]["Conflict"];
            412: components["responses"]["RecipePreconditionFailed"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    removeRecipe: {
        parameters: {
            query?: never;
            header?: {
                /** @description the recipe is changed only if it is still the one with this `ETag`, or (`*`) if there is one; else 412 with what is there now */
                "If-Match"?: components["parameters"]["recipeIfMatch"];
                /** @description `*`: the recipe is made only if there is none of this name; else 412 with what is there now */
                "If-None-Match"?: components["parameters"]["recipeIfNoneMatch"];
            };
            path: {
                /**
                 * @description 1 to 64 letters, digits, - _ .
                 * @example warm-up
                 */
                recipe: components["parameters"]["recipe"];
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description removed */
            204: {
                headers: {
                    [name: string]: unknown;
                };
                content?: never;
            };
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Conflict"];
            412: components["responses"]["RecipePreconditionFailed"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    runRecipe: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /**
                 * @description 1 to 64 letters, digits, - _ .
                 * @example warm-up
                 */
                recipe: components["parameters"]["recipe"];
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                /**
                 * @example {
                 *       "arguments": {
                 *         "distance": 25
                 *       }
                 *     }
                 */
                "application/json": {
                    /** @description values by parameter name */
                    arguments?: Record<string, never>;
                    /** @description check alone */
                    dry_run?: boolean;
                };
            };
        };
        responses: {
            /** @description the answer to `dry_run`; nothing was started */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["RecipeCheck"];
                };
            };
            /** @description started */
            202: {
                headers: {
                    Location?: string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["RecipeReport"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Conflict"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            default: components["responses"]["Problem"];
        };
    };
    listRecipeRuns: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /**
                 * @description 1 to 64 letters, digits, - _ .
                 * @example warm-up
                 */
                recipe: components["parameters"]["recipe"];
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description the reports */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["RecipeReportHead"][];
                };
            };
            404: components["responses"]["NotFound"];
            default: components["responses"]["Problem"];
        };
    };
    getRecipeRun: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /**
                 * @description 1 to 64 letters, digits, - _ .
                 * @example warm-up
                 */
                recipe: components["parameters"]["recipe"];
                /**
                 * @description number of the run; counts up per recipe, also over restarts
                 * @example 1
                 */
                run: components["parameters"]["run"];
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description the report */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["RecipeReport"];
                };
            };
            404: components["responses"]["NotFound"];
            default: components["responses"]["Problem"];
        };
    };
    cancelRecipeRun: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /**
                 * @description 1 to 64 letters, digits, - _ .
                 * @example warm-up
                 */
                recipe: components["parameters"]["recipe"];
                /**
                 * @description number of the run; counts up per recipe, also over restarts
                 * @example 1
                 */
                run: components["parameters"]["run"];
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description it is being ended; the report says when it has */
            202: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["RecipeReport"];
                };
            };
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Conflict"];
            default: components["responses"]["Problem"];
        };
    };
    listSnapshots: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example feeder */
                axis: components["parameters"]["axis"];
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description the snapshots */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["SnapshotInfo"][];
                };
            };
            404: components["responses"]["NotFound"];
            default: components["responses"]["Problem"];
        };
    };
    takeSnapshot: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example feeder */
                axis: components["parameters"]["axis"];
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                /**
                 * @example {
                 *       "name": "as delivered",
                 *       "comment": "",
                 *       "from": "device"
                 *     }
                 */
                "application/json": components["schemas"]["SnapshotRequest"];
            };
        };
        responses: {
            /** @description taken */
            201: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Snapshot"];
                };
            };
            /** @description it takes longer; its progress is at Location */
            202: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["JobRunning"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Conflict"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    getSnapshotProgress: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example feeder */
                axis: components["parameters"]["axis"];
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description progress */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["JobProgress"];
                };
            };
            404: components["responses"]["NotFound"];
            default: components["responses"]["Problem"];
        };
    };
    getSnapshot: {
        parameters: {
            query?: {
                /** @description dcf - its values in the maker's description that the drive names, as a file for tools of CANopen */
                format?: "json" | "dcf";
            };
            header?: never;
            path: {
                /** @example feeder */
                axis: components["parameters"]["axis"];
                snapshot: components["parameters"]["snapshot"];
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description the snapshot; of a DCF, the header Left-Out says how many of its values the file cannot hold */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Snapshot"];
                    "text/plain": string;
                };
            };
            400: components["responses"]["BadRequest"];
            404: components["responses"]["NotFound"];
            406: components["responses"]["NotAcceptable"];
            409: components["responses"]["Conflict"];
            default: components["responses"]["Problem"];
        };
    };
    removeSnapshot: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example feeder */
                axis: components["parameters"]["axis"];
                snapshot: components["parameters"]["snapshot"];
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description removed */
            204: {
                headers: {
                    [name: string]: unknown;
                };
                content?: never;
            };
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    diffSnapshot: {
        parameters: {
            query?: {
                /** @description default, device, stored, snapshot:N, axis:NAME or axis:NAME:N */
                with?: string;
            };
            header?: never;
            path: {
                /** @example feeder */
                axis: components["parameters"]["axis"];
                snapshot: components["parameters"]["snapshot"];
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description row by row */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["SnapshotDiff"];
                };
            };
            400: components["responses"]["BadRequest"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Conflict"];
            default: components["responses"]["Problem"];
        };
    };
    restoreSnapshot: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example feeder */
                axis: components["parameters"]["axis"];
                snapshot: components["parameters"]["snapshot"];
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                /**
                 * @example {
                 *       "dry_run": true
                 *     }
                 */
                "application/json": components["schemas"]["RestoreRequest"];
            };
        };
        responses: {
            /** @description what was changed, or would be */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["WriteReport"];
                };
            };
            /** @description it takes longer; its progress is at Location */
            202: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["JobRunning"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Conflict"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            default: components["responses"]["Problem"];
        };
    };
    getParameterHistory: {
        parameters: {
            query?: {
                /** @description at most so many */
                limit?: number;
            };
            header?: never;
            path: {
                /** @example feeder */
                axis: components["parameters"]["axis"];
                /**
                 * @description id or name of the catalogue; elements of an array with their number in brackets, percent-encoded (`PP%5B5%5D`)
                 * @example AC
                 */
                parameter: components["parameters"]["parameter"];
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description the writes */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["ParameterChange"][];
                };
            };
            400: components["responses"]["BadRequest"];
            404: components["responses"]["NotFound"];
            default: components["responses"]["Problem"];
        };
    };
    exportParameters: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @example feeder */
                axis: components["parameters"]["axis"];
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description one line per parameter */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "text/csv": string;
                };
            };
            404: components["responses"]["NotFound"];
            default: components["responses"]["Problem"];
        };
    };
    importParameters: {
        parameters: {
            query?: {
                /** @description only tell */
                dry_run?: components["schemas"]["Flag"];
                /** @description 1 writes also what the drive is reached by (`addressing` of a parameter); without it that is in `skipped` */
                include_addressing?: components["schemas"]["Flag"];
                /** @description 1 writes also what acts at once instead of configuring (`live` of a parameter); without it that is in `skipped` */
                include_live?: components["schemas"]["Flag"];
            };
            header?: never;
            path: {
                /** @example feeder */
                axis: components["parameters"]["axis"];
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                /**
                 * @example parameter,value
                 *     AC,20000
                 */
                "text/csv": string;
            };
        };
        responses: {
            /** @description what was changed, or would be */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["WriteReport"];
                };
            };
            /** @description it takes longer; its progress is at Location */
            202: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["JobRunning"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Conflict"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            default: components["responses"]["Problem"];
        };
    };
    getStage: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description the stage */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Stage"];
                };
            };
            default: components["responses"]["Problem"];
        };
    };
    stageSite: {
        parameters: {
            query?: {
                /** @description 1 replaces a stage of another client that is not applied yet */
                replace?: components["parameters"]["replaceStage"];
            };
            header?: {
                /** @description the change is made only if the site still has this revision (`"3"`, from `ETag` or `Site-Revision`); else 412 */
                "If-Match"?: components["parameters"]["ifMatch"];
            };
            path?: never;
            cookie?: never;
        };
        requestBody: {
            content: {
                /**
                 * @example {
                 *       "lines": [],
                 *       "drives": [],
                 *       "axes": [],
                 *       "mappings": []
                 *     }
                 */
                "application/json": components["schemas"]["Site"];
            };
        };
        responses: {
            /** @description staged */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Stage"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            409: components["responses"]["Conflict"];
            412: components["responses"]["PreconditionFailed"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            default: components["responses"]["Problem"];
        };
    };
    discardStage: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description removed */
            204: {
                headers: {
                    [name: string]: unknown;
                };
                content?: never;
            };
            403: components["responses"]["Forbidden"];
            409: components["responses"]["Conflict"];
            default: components["responses"]["Problem"];
        };
    };
    applyStage: {
        parameters: {
            query?: never;
            header?: {
                /** @description the change is made only if the site still has this revision (`"3"`, from `ETag` or `Site-Revision`); else 412 */
                "If-Match"?: components["parameters"]["ifMatch"];
            };
            path?: never;
            cookie?: never;
        };
        requestBody: {
            content: {
                /**
                 * @example {
                 *       "confirm_within_s": 60
                 *     }
                 */
                "application/json": components["schemas"]["ApplyRequest"];
            };
        };
        responses: {
            /** @description applied */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Stage"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            409: components["responses"]["Conflict"];
            412: components["responses"]["PreconditionFailed"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    confirmStage: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description confirmed */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Stage"];
                };
            };
            403: components["responses"]["Forbidden"];
            409: components["responses"]["Conflict"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    rollBackStage: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description rolled back */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Stage"];
                };
            };
            403: components["responses"]["Forbidden"];
            409: components["responses"]["Conflict"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    listSiteHistory: {
        parameters: {
            query?: {
                /** @description at most so many */
                limit?: number;
                /** @description only revisions below this one; 0 from the newest on */
                before?: number;
            };
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description revisions */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["SiteRevision"][];
                };
            };
            400: components["responses"]["BadRequest"];
            default: components["responses"]["Problem"];
        };
    };
    getSiteRevision: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                revision: components["parameters"]["revision"];
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description the site as it was */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Site"];
                };
            };
            404: components["responses"]["NotFound"];
            default: components["responses"]["Problem"];
        };
    };
    restoreSiteRevision: {
        parameters: {
            query?: {
                /** @description 1 replaces a stage of another client that is not applied yet */
                replace?: components["parameters"]["replaceStage"];
            };
            header?: {
                /** @description the change is made only if the site still has this revision (`"3"`, from `ETag` or `Site-Revision`); else 412 */
                "If-Match"?: components["parameters"]["ifMatch"];
            };
            path: {
                revision: components["parameters"]["revision"];
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description staged */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Stage"];
                };
            };
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Conflict"];
            412: components["responses"]["PreconditionFailed"];
            422: components["responses"]["Unprocessable"];
            default: components["responses"]["Problem"];
        };
    };
    getBackup: {
        parameters: {
            query?: never;
            header?: {
                /** @description seals the backup, or opens a sealed one; 12 to 256 characters, percent-encoded (each byte but letters, digits and `-._~` as `%XX`) */
                "X-Backup-Passphrase"?: components["parameters"]["backupPassphrase"];
            };
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description a tar of the database, the certificates, the configuration and their checksums; with a passphrase sealed with it */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/octet-stream": string;
                };
            };
            422: components["responses"]["Unprocessable"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    putBackup: {
        parameters: {
            query?: never;
            header?: {
                /** @description seals the backup, or opens a sealed one; 12 to 256 characters, percent-encoded (each byte but letters, digits and `-._~` as `%XX`) */
                "X-Backup-Passphrase"?: components["parameters"]["backupPassphrase"];
            };
            path?: never;
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/octet-stream": string;
            };
        };
        responses: {
            /** @description laid down */
            202: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["RestoreAnswer"];
                };
            };
            403: components["responses"]["Forbidden"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    getPendingBackup: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description what waits */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["PendingBackup"];
                };
            };
            default: components["responses"]["Problem"];
        };
    };
    cancelPendingBackup: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description taken away */
            204: {
                headers: {
                    [name: string]: unknown;
                };
                content?: never;
            };
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    getRegisters: {
        parameters: {
            query?: {
                /** @description Modbus unit */
                unit?: number;
                /** @description table */
                table?: "holding_registers" | "input_registers" | "coils" | "discrete_inputs";
                /** @description counted from 0 */
                address?: number;
                /** @description how many */
                count?: number;
            };
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description words or bits, or the exception that a client gets */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Registers"];
                };
            };
            400: components["responses"]["BadRequest"];
            default: components["responses"]["Problem"];
        };
    };
    getMappingList: {
        parameters: {
            query?: {
                /** @description table (`register_number` counts from 1, as 40001 does; `engineering_unit` is the point's, before scale and offset), page, or IEC 61131-3 structures, one for each run of addresses without a gap */
                format?: "csv" | "html" | "st";
            };
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description the list */
            200: {
                headers: {
                    "Mapping-Revision"?: string;
                    [name: string]: unknown;
                };
                content: {
                    "text/csv": string;
                    "text/html": string;
                    "text/plain": string;
                };
            };
            400: components["responses"]["BadRequest"];
            default: components["responses"]["Problem"];
        };
    };
    getNextFree: {
        parameters: {
            query?: {
                /** @description Modbus unit */
                unit?: number;
                /** @description table */
                table?: "holding_registers" | "input_registers" | "coils" | "discrete_inputs";
                /** @description registers or bits */
                words?: number;
                /** @description the place is a multiple of it; left out, 64 for 64 words (the block of an axis), else 1 */
                align?: number;
            };
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description the place */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Place"];
                };
            };
            400: components["responses"]["BadRequest"];
            409: components["responses"]["Conflict"];
            default: components["responses"]["Problem"];
        };
    };
    getTrends: {
        parameters: {
            query?: {
                /** @description names with commas, at most 64; left out - all, the first 64 */
                axes?: string;
                /** @description some of position, velocity, demand, following_error, state, with commas; left out - all */
                points?: string;
                /** @description ms since 1970; left out - a minute before `to` */
                from?: number;
                /** @description ms since 1970; left out - now */
                to?: number;
                columns?: number;
            };
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description as JSON or CSV, by Accept */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Trends"];
                    "text/csv": string;
                };
            };
            400: components["responses"]["BadRequest"];
            404: components["responses"]["NotFound"];
            406: components["responses"]["NotAcceptable"];
            default: components["responses"]["Problem"];
        };
    };
    getRecordedSteps: {
        parameters: {
            query?: {
                /** @description names with commas, at most 64; left out - all, the first 64 */
                axes?: string;
                /** @description ms since 1970; left out - a minute before `to` */
                from?: number;
                /** @description ms since 1970; left out - now */
                to?: number;
            };
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description the steps */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["RecordedSteps"];
                };
            };
            400: components["responses"]["BadRequest"];
            404: components["responses"]["NotFound"];
            default: components["responses"]["Problem"];
        };
    };
    listCaptures: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description those that run (or were given up lately) first, then newest first */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["CaptureList"];
                };
            };
            default: components["responses"]["Problem"];
        };
    };
    armCapture: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["CaptureWish"];
            };
        };
        responses: {
            /** @description armed */
            201: {
                headers: {
                    /** @description where it is */
                    Location?: string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Capture"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            409: components["responses"]["Conflict"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            503: components["responses"]["Unavailable"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    getCapture: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                capture: components["parameters"]["capture"];
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description as JSON or CSV, by Accept */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["CaptureWithRows"];
                    "text/csv": string;
                };
            };
            404: components["responses"]["NotFound"];
            406: components["responses"]["NotAcceptable"];
            409: components["responses"]["Conflict"];
            default: components["responses"]["Problem"];
        };
    };
    removeCapture: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                capture: components["parameters"]["capture"];
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description cancelled or deleted */
            204: {
                headers: {
                    [name: string]: unknown;
                };
                content?: never;
            };
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            503: components["responses"]["Unavailable"];
            default: components["responses"]["Problem"];
        };
    };
    renameCapture: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                capture: components["parameters"]["capture"];
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["RecordingChange"];
                "application/merge-patch+json": components["schemas"]["RecordingChange"];
            };
        };
        responses: {
            /** @description renamed */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Capture"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Conflict"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            503: components["responses"]["Unavailable"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    listRecordings: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description newest first */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["RecordingList"];
                };
            };
            default: components["responses"]["Problem"];
        };
    };
    makeRecording: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": {
                    name: components["schemas"]["RecordingName"];
                    why?: string;
                };
            };
        };
        responses: {
            /** @description written */
            201: {
                headers: {
                    /** @description where it is */
                    Location?: string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Recording"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            409: components["responses"]["Conflict"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            503: components["responses"]["Unavailable"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    getRecording: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                recording: components["parameters"]["recording"];
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description the file (.axr), or what it is, by Accept */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/vnd.axisgate.axr": string;
                    "application/json": components["schemas"]["Recording"];
                };
            };
            404: components["responses"]["NotFound"];
            406: components["responses"]["NotAcceptable"];
            default: components["responses"]["Problem"];
        };
    };
    removeRecording: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                recording: components["parameters"]["recording"];
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description deleted */
            204: {
                headers: {
                    [name: string]: unknown;
                };
                content?: never;
            };
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            default: components["responses"]["Problem"];
        };
    };
    renameRecording: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                recording: components["parameters"]["recording"];
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["RecordingChange"];
                "application/merge-patch+json": components["schemas"]["RecordingChange"];
            };
        };
        responses: {
            /** @description renamed; it is not deleted by itself any more */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Recording"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Conflict"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    playBackRecording: {
        parameters: {
            query?: {
                /** @description ms since 1970; left out - the end */
                at?: number;
                frames?: number;
                columns?: number;
            };
            header?: never;
            path: {
                recording: components["parameters"]["recording"];
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description the instant */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Playback"];
                };
            };
            400: components["responses"]["BadRequest"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Conflict"];
            default: components["responses"]["Problem"];
        };
    };
    getFleet: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description what they told last; none while `[dds] enabled` is false */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["FleetList"];
                };
            };
            default: components["responses"]["Problem"];
        };
    };
    commandFleetAxis: {
        parameters: {
            query?: {
                /** @description seconds to wait until the command is done */
                wait?: components["parameters"]["wait"];
            };
            header?: never;
            path: {
                /** @description name of a gateway of the domain */
                gateway: string;
                /** @example feeder */
                axis: components["parameters"]["axis"];
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                /**
                 * @example {
                 *       "command": "move_absolute",
                 *       "position": 100,
                 *       "velocity": 50
                 *     }
                 */
                "application/json": components["schemas"]["Command"];
            };
        };
        responses: {
            /** @description acknowledged, or done */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["CommandAnswer"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Refused"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            503: components["responses"]["Unavailable"];
            504: components["responses"]["NoAnswer"];
            default: components["responses"]["Problem"];
        };
    };
    listAssemblies: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description all of them, by instance */
            200: {
                headers: {
                    "Site-Revision": components["headers"]["SiteRevision"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Assemblies"];
                };
            };
            default: components["responses"]["Problem"];
        };
    };
    exportAssemblies: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description one line per assembly below a line of column names */
            200: {
                headers: {
                    "Site-Revision": components["headers"]["SiteRevision"];
                    [name: string]: unknown;
                };
                content: {
                    "text/csv": string;
                };
            };
            default: components["responses"]["Problem"];
        };
    };
    replaceAssemblies: {
        parameters: {
            query?: {
                /** @description 1 answers what would change, and changes nothing */
                dry_run?: components["schemas"]["Flag"];
            };
            header?: {
                /** @description the change is made only if the site still has this revision (`"3"`, from `ETag` or `Site-Revision`); else 412 */
                "If-Match"?: components["parameters"]["ifMatch"];
            };
            path?: never;
            cookie?: never;
        };
        requestBody: {
            content: {
                /**
                 * @example instance,direction,unit,address,registers
                 *     300,input,2,0,2
                 */
                "text/csv": string;
            };
        };
        responses: {
            /** @description taken; with `dry_run` what would be */
            200: {
                headers: {
                    "Site-Revision": components["headers"]["SiteRevision"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["AssemblyImport"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            412: components["responses"]["PreconditionFailed"];
            413: components["responses"]["TooLarge"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    addAssemblies: {
        parameters: {
            query?: {
                /** @description 1 answers what would change, and changes nothing */
                dry_run?: components["schemas"]["Flag"];
            };
            header?: {
                /** @description the change is made only if the site still has this revision (`"3"`, from `ETag` or `Site-Revision`); else 412 */
                "If-Match"?: components["parameters"]["ifMatch"];
            };
            path?: never;
            cookie?: never;
        };
        requestBody: {
            content: {
                /**
                 * @example instance,direction,unit,address,registers
                 *     300,input,2,0,2
                 */
                "text/csv": string;
            };
        };
        responses: {
            /** @description taken; with `dry_run` what would be */
            200: {
                headers: {
                    "Site-Revision": components["headers"]["SiteRevision"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["AssemblyImport"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            412: components["responses"]["PreconditionFailed"];
            413: components["responses"]["TooLarge"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    getAssembly: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @description assembly instance, 1 to 65535 */
                instance: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description the entry */
            200: {
                headers: {
                    "Site-Revision": components["headers"]["SiteRevision"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["AssemblySpec"];
                };
            };
            404: components["responses"]["NotFound"];
            default: components["responses"]["Problem"];
        };
    };
    putAssembly: {
        parameters: {
            query?: never;
            header?: {
                /** @description the change is made only if the site still has this revision (`"3"`, from `ETag` or `Site-Revision`); else 412 */
                "If-Match"?: components["parameters"]["ifMatch"];
            };
            path: {
                /** @description assembly instance, 1 to 65535 */
                instance: string;
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                /**
                 * @example {
                 *       "direction": "input",
                 *       "unit": 2,
                 *       "address": 0,
                 *       "registers": 4
                 *     }
                 */
                "application/json": components["schemas"]["AssemblyEntry"];
            };
        };
        responses: {
            /** @description the entry as it is now */
            200: {
                headers: {
                    "Site-Revision": components["headers"]["SiteRevision"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["AssemblySpec"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Conflict"];
            422: components["responses"]["Unprocessable"];
            default: components["responses"]["Problem"];
        };
    };
    removeAssembly: {
        parameters: {
            query?: never;
            header?: {
                /** @description the change is made only if the site still has this revision (`"3"`, from `ETag` or `Site-Revision`); else 412 */
                "If-Match"?: components["parameters"]["ifMatch"];
            };
            path: {
                /** @description assembly instance, 1 to 65535 */
                instance: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description it is gone */
            204: {
                headers: {
                    "Site-Revision": components["headers"]["SiteRevision"];
                    [name: string]: unknown;
                };
                content?: never;
            };
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Conflict"];
            default: components["responses"]["Problem"];
        };
    };
    listProfiles: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description all languages with their registers, and the site's profiles */
            200: {
                headers: {
                    "Site-Revision": components["headers"]["SiteRevision"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Profiles"];
                };
            };
            default: components["responses"]["Problem"];
        };
    };
    getProfile: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @description Modbus unit, 2 to 254 */
                unit: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description the entry */
            200: {
                headers: {
                    "Site-Revision": components["headers"]["SiteRevision"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["ProfileSpec"];
                };
            };
            404: components["responses"]["NotFound"];
            default: components["responses"]["Problem"];
        };
    };
    putProfile: {
        parameters: {
            query?: never;
            header?: {
                /** @description the change is made only if the site still has this revision (`"3"`, from `ETag` or `Site-Revision`); else 412 */
                "If-Match"?: components["parameters"]["ifMatch"];
            };
            path: {
                /** @description Modbus unit, 2 to 254 */
                unit: string;
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                /**
                 * @example {
                 *       "language": "lexium",
                 *       "axes": [
                 *         {
                 *           "axis": "feeder",
                 *           "counts_per_unit": 51200
                 *         }
                 *       ]
                 *     }
                 */
                "application/json": components["schemas"]["ProfileEntry"];
            };
        };
        responses: {
            /** @description the entry as it is now */
            200: {
                headers: {
                    "Site-Revision": components["headers"]["SiteRevision"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["ProfileSpec"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Conflict"];
            422: components["responses"]["Unprocessable"];
            default: components["responses"]["Problem"];
        };
    };
    removeProfile: {
        parameters: {
            query?: never;
            header?: {
                /** @description the change is made only if the site still has this revision (`"3"`, from `ETag` or `Site-Revision`); else 412 */
                "If-Match"?: components["parameters"]["ifMatch"];
            };
            path: {
                /** @description Modbus unit, 2 to 254 */
                unit: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description it is gone */
            204: {
                headers: {
                    "Site-Revision": components["headers"]["SiteRevision"];
                    [name: string]: unknown;
                };
                content?: never;
            };
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Conflict"];
            default: components["responses"]["Problem"];
        };
    };
    listMappingUnits: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description the units, ascending */
            200: {
                headers: {
                    "Site-Revision": components["headers"]["SiteRevision"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["ModbusUnit"][];
                };
            };
            default: components["responses"]["Problem"];
        };
    };
    changeMappingUnit: {
        parameters: {
            query?: never;
            header?: {
                /** @description the change is made only if the site still has this revision (`"3"`, from `ETag` or `Site-Revision`); else 412 */
                "If-Match"?: components["parameters"]["ifMatch"];
            };
            path: {
                /** @description Modbus unit, 2 to 254 */
                unit: string;
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                /**
                 * @example {
                 *       "gaps": "refuse"
                 *     }
                 */
                "application/json": components["schemas"]["ModbusUnitChange"];
            };
        };
        responses: {
            /** @description the unit as it is now */
            200: {
                headers: {
                    "Site-Revision": components["headers"]["SiteRevision"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["ModbusUnit"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Conflict"];
            412: components["responses"]["PreconditionFailed"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    addMappingTemplate: {
        parameters: {
            query?: never;
            header?: {
                /** @description the change is made only if the site still has this revision (`"3"`, from `ETag` or `Site-Revision`); else 412 */
                "If-Match"?: components["parameters"]["ifMatch"];
            };
            path?: never;
            cookie?: never;
        };
        requestBody: {
            content: {
                /**
                 * @example {
                 *       "template": "standard_map",
                 *       "axis": "feeder",
                 *       "unit": 2,
                 *       "address": 0,
                 *       "dry_run": true
                 *     }
                 */
                "application/json": components["schemas"]["TemplateRequest"];
            };
        };
        responses: {
            /** @description what would be added */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["TemplateAnswer"];
                };
            };
            /** @description added and in force */
            201: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["TemplateAnswer"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            409: components["responses"]["Conflict"];
            412: components["responses"]["PreconditionFailed"];
            415: components["responses"]["UnsupportedMediaType"];
            422: components["responses"]["Unprocessable"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    listEvents: {
        parameters: {
            query?: {
                /** @description an event id (events with a greater id) or an RFC 3339 time (events not older) */
                since?: string;
                /** @description of this axis alone */
                axis?: string;
                /** @description of this severity or a higher one */
                severity?: components["schemas"]["Severity"];
                /**
                 * @description of this kind alone
                 * @example alarm
                 */
                kind?: string;
                /** @description the events that first raised the alarms of `/alarms` which are in this state now; an alarm has the id of that event */
                state?: components["schemas"]["AlarmFilter"];
                /** @description events with a smaller id, for paging backwards */
                before?: number;
                limit?: number;
                /** @description which ones, if there are more than `limit`; `oldest` reads on from `since` without a gap */
                order?: "newest" | "oldest";
                /** @description json, csv (a table) or text (a line per event); without it `Accept` decides */
                format?: "json" | "csv" | "text";
            };
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description the events */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Event"][];
                    "text/csv": string;
                    "text/plain": string;
                };
            };
            400: components["responses"]["BadRequest"];
            504: components["responses"]["NoAnswer"];
            default: components["responses"]["Problem"];
        };
    };
    listAlarms: {
        parameters: {
            query?: {
                /** @description those in this state alone; the counts are of all */
                state?: components["schemas"]["AlarmFilter"];
            };
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description the list */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["AlarmList"];
                };
            };
            default: components["responses"]["Problem"];
        };
    };
    acknowledgeAlarms: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody: {
            content: {
                /**
                 * @example {
                 *       "all": true,
                 *       "comment": "seen at the machine"
                 *     }
                 */
                "application/json": components["schemas"]["AcknowledgeAlarms"];
            };
        };
        responses: {
            /** @description done, and on disk */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": {
                        /** @description how many */
                        acknowledged: number;
                        /** @description how many are left */
                        unacknowledged: number;
                    };
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            409: components["responses"]["Conflict"];
            422: components["responses"]["Unprocessable"];
            default: components["responses"]["Problem"];
        };
    };
    acknowledgeAlarm: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /**
                 * @description number of an alarm of the list
                 * @example 12
                 */
                alarm: components["parameters"]["alarm"];
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                /**
                 * @example {
                 *       "comment": "the guard was open"
                 *     }
                 */
                "application/json": {
                    comment?: string;
                };
            };
        };
        responses: {
            /** @description done, and on disk; `normal` if it is off the list */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Alarm"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Conflict"];
            422: components["responses"]["Unprocessable"];
            default: components["responses"]["Problem"];
        };
    };
    shelveAlarm: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /**
                 * @description number of an alarm of the list
                 * @example 12
                 */
                alarm: components["parameters"]["alarm"];
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                /**
                 * @example {
                 *       "for_s": 3600,
                 *       "reason": "the sensor is being replaced"
                 *     }
                 */
                "application/json": {
                    for_s: number;
                    reason: string;
                };
            };
        };
        responses: {
            /** @description shelved, and on disk */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Alarm"];
                };
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Conflict"];
            422: components["responses"]["Unprocessable"];
            default: components["responses"]["Problem"];
        };
    };
    unshelveAlarm: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /**
                 * @description number of an alarm of the list
                 * @example 12
                 */
                alarm: components["parameters"]["alarm"];
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description done, and on disk; `normal` if it is off the list */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Alarm"];
                };
            };
            403: components["responses"]["Forbidden"];
            404: components["responses"]["NotFound"];
            409: components["responses"]["Conflict"];
            default: components["responses"]["Problem"];
        };
    };
    openStream: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description switched to WebSocket */
            101: {
                headers: {
                    [name: string]: unknown;
                };
                content?: never;
            };
            400: components["responses"]["BadRequest"];
            403: components["responses"]["Forbidden"];
            /** @description the request was not a WebSocket handshake of version 13 */
            426: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            default: components["responses"]["Problem"];
        };
    };
    getSession: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description the identity */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["SessionInfo"];
                };
            };
            default: components["responses"]["Problem"];
        };
    };
    signIn: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["SignIn"];
            };
        };
        responses: {
            /** @description signed in */
            200: {
                headers: {
                    "Set-Cookie"?: string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["SessionInfo"];
                };
            };
            default: components["responses"]["Problem"];
        };
    };
    signOut: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description ended */
            204: {
                headers: {
                    [name: string]: unknown;
                };
                content?: never;
            };
            default: components["responses"]["Problem"];
        };
    };
    firstSignIn: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["FirstSignIn"];
            };
        };
        responses: {
            /** @description made and signed in */
            200: {
                headers: {
                    "Set-Cookie"?: string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["SessionInfo"];
                };
            };
            409: components["responses"]["Conflict"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    listUsers: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description the users */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["User"][];
                };
            };
            default: components["responses"]["Problem"];
        };
    };
    addUser: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["NewUser"];
            };
        };
        responses: {
            /** @description made */
            201: {
                headers: {
                    ETag: components["headers"]["StateETag"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["User"];
                };
            };
            409: components["responses"]["Conflict"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    getUser: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                user: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description the user */
            200: {
                headers: {
                    ETag: components["headers"]["StateETag"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["User"];
                };
            };
            404: components["responses"]["NotFound"];
            default: components["responses"]["Problem"];
        };
    };
    removeUser: {
        parameters: {
            query?: never;
            header?: {
                /** @description it is done only if the state is still the one with this `ETag`; else 412 with what is there now */
                "If-Match"?: components["parameters"]["stateIfMatch"];
            };
            path: {
                user: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description removed */
            204: {
                headers: {
                    [name: string]: unknown;
                };
                content?: never;
            };
            404: components["responses"]["NotFound"];
            409: components["responses"]["Conflict"];
            412: components["responses"]["StatePreconditionFailed"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    changeUser: {
        parameters: {
            query?: never;
            header?: {
                /** @description it is done only if the state is still the one with this `ETag`; else 412 with what is there now */
                "If-Match"?: components["parameters"]["stateIfMatch"];
            };
            path: {
                user: string;
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["UserChange"];
                "application/merge-patch+json": components["schemas"]["UserChange"];
            };
        };
        responses: {
            /** @description changed */
            200: {
                headers: {
                    ETag: components["headers"]["StateETag"];
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["User"];
                };
            };
            404: components["responses"]["NotFound"];
            409: components["responses"]["Conflict"];
            412: components["responses"]["StatePreconditionFailed"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    changePassword: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                user: string;
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["PasswordChange"];
            };
        };
        responses: {
            /** @description changed; all sessions of the user have ended */
            204: {
                headers: {
                    [name: string]: unknown;
                };
                content?: never;
            };
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    listTokens: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description the tokens, without their secrets */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Token"][];
                };
            };
            default: components["responses"]["Problem"];
        };
    };
    addToken: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["NewToken"];
            };
        };
        responses: {
            /** @description made */
            201: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["MadeToken"];
                };
            };
            409: components["responses"]["Conflict"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
    removeToken: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                token: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description removed */
            204: {
                headers: {
                    [name: string]: unknown;
                };
                content?: never;
            };
            404: components["responses"]["NotFound"];
            507: components["responses"]["NotStored"];
            default: components["responses"]["Problem"];
        };
    };
}
