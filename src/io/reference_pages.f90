!> Reference pages of the manual in Markdown, generated from the declarations of the models: the keys of case and study files, the
!> columns and quantities of results. `gudgeon --reference` prints them.
module reference_pages
  use kinds, only: dp
  use error_handling, only: error_t
  use model_parameters, only: key_t, logical_kind
  use case_schema, only: group_definition_t, key_table_t, find_key, name_in_file, is_first_of_name, is_apart, shown_group
  use case_definition, only: case_t
  use case_file, only: parse_case, template
  use trace_columns, only: choose_columns, unit_in
  use trace_row, only: column_list_t, name_length, of_run, of_cycle
  use text_tools, only: replaced
  use summary_quantities, only: quantity_t, quantities_of_runs, event_columns, wear_columns, study_columns
  use named_oils, only: oils, sources
  use number_text, only: short_text
  implicit none
  private
  public :: keys_reference, results_reference, oils_reference

  character(len=*), parameter :: newline = achar(10)

  !> A kind of scene: changes to the case of the template, separated by blanks.
  type :: scene_kind_t
    character(len=80) :: title = ''
    character(len=400) :: changes = ''
  end type scene_kind_t

  character(len=*), parameter :: play = 'joint.kind=clearance ', contact = 'contact.law=hertz ', &
    film = 'lubrication.viscosity=0.0117 lubrication.report=T ', &
    engine = 'combustion.bore=0.07 combustion.compression_ratio=9 combustion.heat_capacity_ratio=1.4 '// &
    'combustion.heat=165 combustion.wiebe_efficiency=5 combustion.wiebe_form=3 combustion.start_deg=340 '// &
    'combustion.duration_deg=40'

  !> Kinds of scenes that together have every column.
  type(scene_kind_t), parameter :: kinds(23) = [ &
    scene_kind_t('Every scene', 'drive.kind=constant_speed'), &
    scene_kind_t('Joint with clearance (the last three columns only with `&contact`)', play//contact), &
    scene_kind_t('Contact with `geometry = ''conformal''`', play//contact//'contact.geometry=conformal'), &
    scene_kind_t('Friction with bristles (`lugre`, `dahl`, `elasto_plastic`)', play//contact//'friction.law=lugre '// &
      'friction.coefficient=0.1 friction.stribeck_speed=0.01 friction.bristle_stiffness=1e4'), &
    scene_kind_t('Oil film', play//film), &
    scene_kind_t('Oil film of finite length', play//film//'lubrication.law=finite_bearing lubrication.variant=short'), &
    scene_kind_t('Film and contact that share the load', play//film//contact// &
      'lubrication.transition=weighted lubrication.transition_depth=1e-6'), &
    scene_kind_t('Elastic walls (`elastic_film`)', play//film//contact//'lubrication.elastic_film=T'), &
    scene_kind_t('Asperities', play//film//'asperities.roughness=0.4e-6'), &
    scene_kind_t('Film that heats up', play//'lubrication.law=finite_bearing lubrication.variant=short '// &
      'lubrication.oil=SAE30 lubrication.temperature=360 heat.heat_capacity=60 heat.inlet_temperature=350 heat.conductance=1'), &
    scene_kind_t('Wear', play//contact//'wear.rate=1e-15,1e-15'), &
    scene_kind_t('Crank pin with clearance', 'crank_pin.joint.kind=clearance crank_pin.joint.clearance=2e-5 '// &
      'crank_pin.joint.bearing_radius=0.02 crank_pin.contact.law=hertz'), &
    scene_kind_t('Floating piston pin (`pin.kind`)', play//contact//'pin.kind=floating pin.mass=0.1 pin.inertia=1e-5 '// &
      'small_end.joint.kind=clearance small_end.joint.clearance=2e-5 small_end.joint.bearing_radius=0.01'), &
    scene_kind_t('Guide (`kind = ''friction''` has the first column alone)', 'guide.kind=clearance '// &
      'guide.bore_clearance=1e-4 guide.skirt_top=0.02 guide.skirt_bottom=0.02 guide.piston_radius=0.035 '// &
      'guide.piston_inertia=1e-3 guide.stiffness=1e8 guide.coefficient=0'), &
    scene_kind_t('Film of the skirt (`kind = ''lubricated''`)', 'guide.kind=lubricated '// &
      'guide.bore_clearance=1e-4 guide.skirt_top=0.02 guide.skirt_bottom=0.02 guide.piston_radius=0.035 '// &
      'guide.piston_inertia=1e-3 guide.lubrication.viscosity=0.008 guide.asperities.roughness=1e-6'), &
    scene_kind_t('Elastic faces of the skirt (`stiffness` > 0)', 'guide.kind=lubricated guide.stiffness=5e7 '// &
      'guide.bore_clearance=1e-4 guide.skirt_top=0.02 guide.skirt_bottom=0.02 guide.piston_radius=0.035 '// &
      'guide.piston_inertia=1e-3 guide.lubrication.viscosity=0.008 guide.asperities.roughness=1e-6'), &
    scene_kind_t('Gas', engine), &
    scene_kind_t('Piston rings, numbered as in the case (gap and asperities: `model = ''film''`)', 'ring_1.model=film '// &
      'ring_1.height=1.2e-3 ring_1.crown=6e-6 ring_1.tension=8 rings.lubrication.viscosity=0.008 '// &
      'rings.asperities.roughness=0.4e-6 '//engine), &
    scene_kind_t('Gas with a mass (`&working_gas`)', 'working_gas.gas_constant=287 working_gas.temperature=350 '// &
      'wall_heat.wall_temperature=450 '//engine), &
    scene_kind_t('Compressor with the losses of its valves (`&valve`)', 'combustion.cycle=compressor combustion.bore=0.07 '// &
      'combustion.dead_space=0.05 combustion.discharge_pressure=5e5 working_gas.gas_constant=287 '// &
      'working_gas.temperature=300 working_gas.heat_capacity_ratio=1.4 valve_1.area=2e-4 valve_1.lift=1e-3 '// &
      'valve_1.force_area=2.5e-4 valve_1.stiffness=1000 valve_1.mass=1e-3'), &
    scene_kind_t('Elastic rod', 'elastic_rod.section_area=3e-4 elastic_rod.section_inertia=1.5e-8'), &
    scene_kind_t('Elastic crankshaft', 'crankshaft.flywheel_inertia=0.02 crankshaft.torsional_stiffness=2e4'), &
    scene_kind_t('Several cylinders (the numbers are those of the case)', 'crankshaft.flywheel_inertia=0 '// &
      'crankshaft.torsional_stiffness=0 crankshaft.inertia=0.1,0.2 crankshaft.stiffness=1e5 cylinder_1.full=T '// &
      'cylinder_1.station=2 cylinder_2.station=1 damper_1.station=1 damper_1.inertia=0.1 damper_1.stiffness=1e4')]

contains

  !> Page of all groups and keys of a kind of file, or of one group: a section for each group, with a table row for each key.
  function keys_reference(table, only_group) result(text)
    type(key_table_t), intent(in) :: table
    character(len=*), intent(in) :: only_group   !! empty: all groups
    character(len=:), allocatable :: text
    integer :: group, i
    text = ''
    do group = 1, size(table%groups)
      associate (it => table%groups(group))
        if (only_group /= '' .and. it%name /= only_group .and. .not. (it%number == 1 .and. name_in_file(it) == only_group)) cycle
        if (only_group == '' .and. .not. (is_first_of_name(it) .or. is_apart(it))) cycle
        if (is_apart(it)) then
          text = text//'## '//shown_group(trim(it%name))//newline//newline//sentence(trim(it%description))//newline// &
            '`place = '''//it%name(:index(it%name, '.') - 1)//'''` in the group makes it this one.'//newline
        else
          text = text//'## &'//name_in_file(it)//newline//newline//sentence(trim(it%description))//newline
        end if
        if (it%instead_of /= '') text = text//'Cannot be combined with `&'//trim(it%instead_of)//'`.'//newline
        if (it%place /= '' .or. it%is_law) &
          text = text//'`place = ''crank_pin''` in a second group of this name makes it that of the crank pin.'//newline
        text = text//newline//'| key | unit | limits | usual | default | meaning |'//newline// &
          '|---|---|---|---|---|---|'//newline
        do i = it%first, it%last
          text = text//key_row(table%keys, it, table%keys(i))//newline
        end do
        text = text//newline
      end associate
    end do
  end function keys_reference

  function key_row(keys, group, key) result(row)
    type(key_t), intent(in) :: keys(:)   !! of the schema
    type(group_definition_t), intent(in) :: group
    type(key_t), intent(in) :: key       !! one of its keys
    character(len=:), allocatable :: row, default, meaning
    default = trim(key%default)
    if (key%required) then
      default = 'required'
    else if (default == '' .and. allocated(key%laws)) then
      default = 'depends on the law'
    else if (key%kind > logical_kind) then
      default = '`'''//default//'''`'
    end if
    meaning = sentence(trim(key%description))
    if (allocated(key%words)) meaning = meaning//' One of `'//replaced(key%words, ', ', '`, `')//'`.'
    if (allocated(key%laws)) then
      associate (all_laws => keys(find_key(keys, group, key%choice))%words)
        if (key%laws /= all_laws) meaning = meaning//' Only with `'//key%choice//'` '//key%laws//'.'
      end associate
    end if
    row = '| `'//trim(key%name)//'` | '//trim(key%unit)//' | '//trim(key%range)//' | '// &
      trim(key%usual)//' | '//default//' | '//escaped(meaning)//' |'
  end function key_row

  !> Page of all columns and quantities that a result file can have.
  function results_reference() result(text)
    character(len=:), allocatable :: text
    character(len=:), allocatable :: kept
    character(len=name_length), allocatable :: seen(:)
    character(len=len(quantities_of_runs%name)), allocatable :: seen_kept(:)
    type(error_t), allocatable :: error
    type(column_list_t) :: list
    integer :: i
    allocate (seen(0))
    seen_kept = quantities_of_runs%name   ! those that a formula gives where no column does
    kept = ''
    text = '## Columns of NAME.csv'//newline//newline
    do i = 1, size(kinds)
      call columns_of(kinds(i), list, error)
      if (allocated(error)) then
        text = error%message   ! would be found by a test
        return
      end if
      call add_columns(kinds(i)%title, list, seen, text)
      call add_kept(list, seen_kept, kept)
    end do
    text = text//'## Columns of NAME.events.csv'//newline//newline//quantity_table(event_columns)//newline// &
      '## Columns of NAME.wear.csv'//newline//newline//quantity_table(wear_columns)//newline// &
      '## Quantities of NAME.summary.csv'//newline//newline//quantity_table(quantities_of_runs)//kept// &
      newline//'## Columns of NAME.runs.csv and NAME.cycles.csv of a study'//newline//newline//quantity_table(study_columns)
  end function results_reference

  !> Page of the named oils.
  function oils_reference() result(text)
    character(len=:), allocatable :: text
    integer :: i
    text = '## Named oils'//newline//newline//'A grade is a window of viscosities and not an oil: each name stands for a '// &
      'typical oil of its grade, and the window alone is worth 15 % of viscosity either way. Give the oil''s own data sheet '// &
      'where there is one (`viscosity_law`).'//newline//newline//'| oil | at 40 degrees C [mm2/s] | at 100 degrees C [mm2/s] '// &
      '| density at 15 degrees C [kg/m3] | viscosities |'//newline//'|---|---|---|---|---|'//newline
    do i = 1, size(oils)
      associate (oil => oils(i))
        text = text//'| '//trim(oil%name)//' | '//short_text(1e6_dp*oil%viscosities(1))//' | '// &
          short_text(1e6_dp*oil%viscosities(2))//' | '//short_text(oil%density)//' | '//trim(sources(oil%source))//' |'//newline
      end associate
    end do
    text = text//newline//'Densities are typical of data sheets.'//newline
  end function oils_reference

  !> The columns of a kind of scene.
  subroutine columns_of(kind, list, error)
    type(scene_kind_t), intent(in) :: kind
    type(column_list_t), intent(out) :: list
    type(error_t), allocatable, intent(out) :: error
    character(len=*), parameter :: rigid_and_dry = 'joint.kind=ideal contact=none friction=none lubrication=none guide=none '// &
      'heat=none wear=none elastic_rod=none crankshaft=none combustion=none working_gas=none wall_heat=none '// &
      'film_history=none supply=none bore=none shape=none output.columns=standard output.ideal_twin=F '// &
      'output.film_times='
    character(len=:), allocatable :: changes
    character(len=60), allocatable :: overrides(:)
    type(case_t) :: case
    integer :: blank
    changes = rigid_and_dry//' '//trim(kind%changes)//' '
    allocate (overrides(0))
    do while (changes /= '')
      blank = index(changes, ' ')
      overrides = [character(len=60) :: overrides, changes(:blank - 1)]
      changes = changes(blank + 1:)
    end do
    call parse_case(template(), 'reference', overrides, case, error)
    if (.not. allocated(error)) call choose_columns(case, .false., list, error)
  end subroutine columns_of

  !> Append a section with the columns of a scene that no earlier scene had. Columns of the crank pin and of the small end that the
  !> piston pin has too are left out.
  subroutine add_columns(title, list, seen, text)
    character(len=*), intent(in) :: title
    type(column_list_t), intent(in) :: list
    character(len=name_length), allocatable, intent(inout) :: seen(:)
    character(len=:), allocatable, intent(inout) :: text
    character(len=*), parameter :: on_request = ' Only where `&output columns` names it.'
    character(len=:), allocatable :: rows
    character(len=name_length) :: name
    integer :: i
    rows = ''
    do i = 1, size(list%names)
      if (any(seen == list%names(i))) cycle
      if (any(list%names(i)(:10) == ['crank_pin_', 'small_end_']) .and. any(seen == list%names(i)(11:))) cycle
      seen = [character(len=name_length) :: seen, list%names(i)]
      name = list%names(i)
      rows = rows//'| `'//name(:index(name, '[') - 1)//'` | '//unit_in(name)//' | '// &
        escaped(sentence(trim(list%meanings(i))))
      if (list%on_request(i)) rows = rows//on_request
      rows = rows//' |'//newline
    end do
    if (rows /= '') text = text//'### '//trim(title)//newline//newline//'| column | unit | meaning |'//newline//'|---|---|---|'// &
      newline//rows//newline
  end subroutine add_columns

  !> Append the results that are kept of the columns of a scene and that no earlier scene had.
  subroutine add_kept(list, seen, text)
    type(column_list_t), intent(in) :: list
    character(len=len(quantities_of_runs%name)), allocatable, intent(inout) :: seen(:)
    character(len=:), allocatable, intent(inout) :: text
    integer :: i
    do i = 1, size(list%kept)
      associate (kept => list%kept(i))
        if (kept%told /= of_cycle) call add(trim(kept%name), kept%unit, trim(kept%meaning))
        if (kept%told == of_run) cycle
        if (kept%told == of_cycle) call add('cycle_'//trim(kept%name), kept%unit, trim(kept%meaning)//' in the last cycle')
        if (kept%told /= of_cycle) call add('cycle_'//trim(kept%name), kept%unit, 'the same in the last cycle')
        if (kept%has_angle) &
          call add('cycle_'//trim(kept%name)//'_angle', 'deg', 'crank angle then, from 0 to the length of the cycle')
      end associate
    end do

  contains

    subroutine add(name, unit, meaning)
      character(len=*), intent(in) :: name, unit, meaning
      if (any(seen == name)) return
      seen = [character(len=len(seen)) :: seen, name]
      text = text//'| `'//name//'` | '//trim(unit)//' | '//escaped(sentence(meaning))//' |'//newline
    end subroutine add
  end subroutine add_kept

  function quantity_table(list) result(text)
    type(quantity_t), intent(in) :: list(:)
    character(len=:), allocatable :: text
    integer :: i
    text = '| name | unit | meaning |'//newline//'|---|---|---|'//newline
    do i = 1, size(list)
      text = text//'| `'//trim(list(i)%name)//'` | '//trim(list(i)%unit)//' | '// &
        escaped(sentence(trim(list(i)%meaning)))//' |'//newline
    end do
  end function quantity_table

  !> The text with a capital letter and a full stop.
  pure function sentence(text) result(whole)
    character(len=*), intent(in) :: text
    character(len=:), allocatable :: whole
    whole = text
    if (whole == '') return
    if (whole(1:1) >= 'a' .and. whole(1:1) <= 'z' .and. verify(whole(2:2), 'abcdefghijklmnopqrstuvwxyz ') == 0) &
      whole(1:1) = achar(iachar(whole(1:1)) - 32)
    if (whole(len(whole):) /= '.') whole = whole//'.'
  end function sentence

  !> The text without characters that Markdown would interpret as a table column or as HTML.
  pure function escaped(text) result(safe)
    character(len=*), intent(in) :: text
    character(len=:), allocatable :: safe
    safe = replaced(replaced(replaced(text, '|', '\|'), '<', '&lt;'), '*', '\*')
  end function escaped
end module reference_pages
