MODULE M
  CONST robtarget p1:=[[600,100,400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  VAR speeddata slow:=[35,90,5000,1000];
  CONST speeddata same:=slow;
  PROC main()
    MoveL p1,v5,fine,tool0;
    MoveL p1,V1500,fine,tool0;
    MoveL p1,slow,fine,tool0;
    MoveJ p1,slow,fine,tool0;
    MoveL p1,[40,20,5000,1000],fine,tool0;
    MoveJ p1,v7000,fine,tool0;
    MoveL p1,vmax,fine,tool0;
    MoveJ p1,vmax,fine,tool0;
    MoveL p1,same,fine,tool0;
  ENDPROC
ENDMODULE
