!> The columns of elastic members: those of the shapes that a rod has, and of the twist of a crankshaft.
module elastic_columns
  use gudgeon_kinds, only: dp
  use trace_row, only: trace_row_t
  use chain_motion, only: motion_t
  use elastic_members, only: elastic_members_t
  implicit none
  private
  public :: put_elastic_columns

contains

  pure subroutine put_elastic_columns(elastic, motion, row)
    type(elastic_members_t), intent(in) :: elastic
    type(motion_t), intent(in) :: motion
    type(trace_row_t), intent(inout) :: row
    character(len=1) :: number
    integer :: i
    if (allocated(elastic%rod)) then
      associate (rod => elastic%rod)
        do i = 1, rod%n_bending
          write (number, '(i1)') i
          call row%put('rod_mode_'//number//'[m]', motion%shape(i), 'amplitude of this transverse mode of the rod')
        end do
        do i = 1, rod%n_axial
          write (number, '(i1)') i
          if (i == 1) then
            call row%put('rod_stretch[m]', motion%shape(rod%n_bending + 1), 'elongation of the rod between its pins')
          else
            call row%put('rod_axial_'//number//'[m]', motion%shape(rod%n_bending + i), 'amplitude of this axial shape of the rod')
          end if
        end do
        call row%put('rod_mid_deflection[m]', rod%mid_deflection(motion), 'bending deflection of the rod midway between its pins')
        call row%put('rod_strain_energy[J]', rod%strain_energy(motion), 'elastic energy stored in the rod')
      end associate
    end if
    if (.not. allocated(elastic%crankshaft)) return
    call row%put('crankshaft_twist[rad]', motion%flywheel_angle - motion%crank_angle, 'flywheel angle less crank angle')
    call row%put('crankshaft_moment[N.m]', elastic%crankshaft%moment(motion), 'moment of the elastic shaft on the crank')
    call row%put('flywheel_speed[rad/s]', motion%flywheel_speed, 'angular velocity of the flywheel')
  end subroutine put_elastic_columns
end module elastic_columns
