// Short names for the shapes of the HTTP door. In: the types generated from schema/openapi.yaml. Out: the names that the page uses.
// The description says "these members are always there" in a second place, which the generator cannot join; it is joined here.
import type { components } from './schema';

type Schemas = components['schemas'];
type Always<T, K extends keyof T> = T & { [P in K]-?: Exclude<T[P], undefined> };

export type Axis = Always<Schemas['AxisFields'], 'name' | 'drive' | 'channel' | 'number' | 'unit' | 'increments_per_unit'> & Schemas['AxisState'];
export type AxisStateName = Axis['state'];
export type Drive = Always<Schemas['DriveFields'], 'name' | 'line' | 'address' | 'presence'> & {
  readonly family: string;
  readonly axes: string[];
  readonly status: Schemas['DriveStatus'];
};
export type Line = Always<Schemas['LineFields'], 'name' | 'uri'> & {
  readonly drives: string[];
  readonly status: Schemas['LineStatus'] & {
    counters: Schemas['LineCounters'];
    scan_counters: Schemas['LineCounters'];
    families?: { family: string; counters: Schemas['LineCounters'] }[];
    unclaimed?: number;
    has_twin_bus: boolean;
    twin: Schemas['LineStatus'] | null;
  };
};
export type GatewayEvent = Schemas['Event'];
export type Alarm = Schemas['Alarm'];
export type AlarmList = Schemas['AlarmList'];
export type Specimen = Schemas['Specimen'];
export type Severity = Schemas['Severity'];
export type About = Schemas['About'];
export type Action = Schemas['Action'];
export type Command = Schemas['Command'];
export type CommandName = Command['command'];
export type CommandAnswer = Schemas['CommandAnswer'];
export type Value = boolean | number | string;
export type MaybeValue = Value | null;
export type AxisParameter = Schemas['AxisParameter'];
export type NativeReply = Schemas['NativeReply'];
export type HandItem = Schemas['HandItem'];
export type RecipeEntry = Schemas['RecipeEntry'];
export type RecipeRehearsal = Schemas['RecipeRehearsal'];
export type RehearsedSpecimen = Schemas['RehearsedSpecimen'];
export type RecipeReportHead = Schemas['RecipeReportHead'];
export type RecipeReport = Schemas['RecipeReport'];
export type RecipeCheck = Schemas['RecipeCheck'];
export type Fault = Schemas['Fault'];
export type ScanReport = Schemas['ScanReport'];
export type Role = Schemas['Role'];
export type SessionInfo = Schemas['SessionInfo'];
export type User = Schemas['User'];
export type Token = Schemas['Token'];
export type MadeToken = Schemas['MadeToken'];
export type Authority = Schemas['Authority'];
export type FleetGateway = Schemas['FleetGateway'];
export type FleetAxis = Schemas['FleetAxis'];
export type Capture = Schemas['Capture'];
export type CaptureTrigger = NonNullable<Schemas['CaptureTrigger']>;
export type CaptureWish = Schemas['CaptureWish'];
export type CaptureWithRows = Schemas['CaptureWithRows'];
export type CaptureList = Schemas['CaptureList'];
export type Recording = Schemas['Recording'];
export type RecordedSteps = Schemas['RecordedSteps'];
export type RecordingList = Schemas['RecordingList'];
export type Playback = Schemas['Playback'];
export type Trends = Schemas['Trends'];
export type ModbusDoor = Schemas['ModbusDoor'];
export type ProblemDocument = Partial<Schemas['Problem']> & { ticket?: number | null; result?: string; command?: string };
